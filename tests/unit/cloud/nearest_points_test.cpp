// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/nearest_points.hpp"

#include <gtest/gtest.h>

#include <random>

namespace saccade {
namespace {

using Points = std::vector<Eigen::Vector3f>;

constexpr float kNan{std::numeric_limits<float>::quiet_NaN()};

/// Points on a coarse lattice, so that many are equally near, and some that are not finite.
Points lattice_points(std::size_t count, unsigned seed, int edge) {
  std::mt19937 random{seed};
  const auto coordinate = [&] { return 0.25F * static_cast<float>(static_cast<int>(random() % edge)); };
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(coordinate(), coordinate(), coordinate());
    if (i % 37 == 5) points.back().y() = kNan;
  }
  return points;
}

/// By looking at all.
std::uint32_t nearest_of(const Eigen::Vector3f& place, const Points& points, float within_m) {
  std::uint32_t best = kNoNearPoint;
  float best_m2 = within_m * within_m;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f d = points[i] - place;
    const float m2 = d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
    if (!(m2 <= best_m2) || (m2 == best_m2 && best != kNoNearPoint)) continue;
    best = i;
    best_m2 = m2;
  }
  return best;
}

TEST(NearestPoints, AreThoseThatLookingAtAllFinds) {
  std::size_t compared{0};
  for (const int edge : {3, 12, 400}) {
    for (const std::size_t count : {std::size_t{1}, std::size_t{9}, std::size_t{70}, std::size_t{3000}}) {
      const Points to = lattice_points(count, 7, edge);
      const Points from = lattice_points(500, 8, edge);
      for (const float within_m : {0.0F, 0.3F, 5.0F, 1e4F}) {
        const std::vector<std::uint32_t> found = nearest_points(from, to, within_m, Executor::with_threads(3));
        ASSERT_EQ(found.size(), from.size());
        for (std::size_t i = 0; i < from.size(); ++i) {
          ASSERT_EQ(found[i], nearest_of(from[i], to, within_m)) << edge << ' ' << count << ' ' << within_m;
          compared += found[i] == kNoNearPoint ? 0 : 1;
        }
        EXPECT_EQ(found, nearest_points(from, to, within_m, Executor{}));
      }
    }
  }
  EXPECT_GT(compared, 5000U);
}

TEST(NearestPoints, NothingIsNearToNothing) {
  const Points none;
  const Points lost{{kNan, 0.0F, 0.0F}, {3e38F, 0.0F, 0.0F}};
  const Points some{{0.0F, 0.0F, 0.0F}};
  EXPECT_TRUE(nearest_points(none, some, 1.0F, {}).empty());
  EXPECT_EQ(nearest_points(some, none, 1.0F, {}), std::vector<std::uint32_t>{kNoNearPoint});
  EXPECT_EQ(nearest_points(some, lost, 1e30F, {}), std::vector<std::uint32_t>{kNoNearPoint});
  EXPECT_EQ(nearest_points(lost, some, 1e30F, {}), (std::vector<std::uint32_t>{kNoNearPoint, kNoNearPoint}));
}

}  // namespace
}  // namespace saccade
