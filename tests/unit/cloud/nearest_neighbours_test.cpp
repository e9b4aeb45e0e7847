// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/nearest_neighbours.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "saccade/core/simd.hpp"

namespace saccade {
namespace {

std::vector<Eigen::Vector3f> random_points(std::size_t count, unsigned seed, float clumps) {
  std::mt19937 random{seed};
  std::normal_distribution<float> normal;
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < count; ++i) {
    const float scale = i % 3 == 0 ? clumps : 1.0F;
    points.emplace_back(scale * normal(random), scale * normal(random), 0.1F * normal(random));
  }
  return points;
}

float squared(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const float dx = a.x() - b.x();
  const float dy = a.y() - b.y();
  const float dz = a.z() - b.z();
  return dx * dx + dy * dy + dz * dz;
}

/// Squared distances of the k nearest, in ascending order, by looking at all.
std::vector<float> nearest_by_all(const std::vector<Eigen::Vector3f>& points, std::size_t point, std::size_t k) {
  std::vector<float> all;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i != point && points[i].allFinite()) all.push_back(squared(points[i], points[point]));
  }
  std::sort(all.begin(), all.end());
  all.resize(std::min(k, all.size()));
  return all;
}

void expect_nearest(const std::vector<Eigen::Vector3f>& points, std::size_t k) {
  const NearestNeighbours found = nearest_neighbours(points, k, Executor::with_threads(2));
  std::set<std::uint32_t> seen;
  for (std::size_t node = 0; node < found.order.size(); ++node) {
    const std::uint32_t point = found.order[node];
    EXPECT_TRUE(seen.insert(point).second);
    EXPECT_EQ(found.positions_m[node], points[point]);
    std::vector<float> distances;
    std::set<std::uint32_t> distinct;
    std::uint32_t before{0};
    for (const std::uint32_t other : found.of(node)) {
      const float distance = squared(points[found.order[other]], points[point]);
      const bool is_as_near = !distances.empty() && distances.back() == distance;
      EXPECT_TRUE(!is_as_near || before < other);
      before = other;
      EXPECT_NE(other, node);
      distinct.insert(other);
      distances.push_back(distance);
    }
    EXPECT_EQ(distinct.size(), found.count);
    EXPECT_EQ(distances, nearest_by_all(points, point, k)) << "point " << point;
  }
}

TEST(NearestNeighbours, AreThoseThatLookingAtAllPointsFinds) {
  for (const std::size_t count : {1, 2, 3, 8, 9, 17, 500, 2000}) {
    for (const std::size_t k : {1, 10, 64}) {
      SCOPED_TRACE(std::to_string(count) + " points, " + std::to_string(k) + " neighbours");
      expect_nearest(random_points(count, static_cast<unsigned>(count), 0.01F), k);
    }
  }
}

TEST(NearestNeighbours, OfPointsOnAGridAreAtTheRightDistances) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 900; ++i) points.emplace_back(static_cast<float>(i % 30), static_cast<float>(i / 30), 0.0F);
  expect_nearest(points, 10);
}

TEST(NearestNeighbours, OfOddCloudsAreThoseThatLookingAtAllPointsFinds) {
  std::mt19937 random{17};
  std::uniform_real_distribution<float> uniform{0.0F, 1.0F};
  std::vector<Eigen::Vector3f> line;
  std::vector<Eigen::Vector3f> few_places;     // each taken by many points
  std::vector<Eigen::Vector3f> from_a_sensor;  // density falls by six orders of magnitude
  for (int i = 0; i < 700; ++i) {
    line.emplace_back(uniform(random), 0.0F, 0.0F);
    few_places.emplace_back(static_cast<float>(random() % 5), static_cast<float>(random() % 3), -1.0F);
    const float range_m = std::exp(10.0F * uniform(random));
    const float angle = 6.28F * uniform(random);
    from_a_sensor.emplace_back(range_m * std::cos(angle), range_m * std::sin(angle), -2.0F);
  }
  std::vector<Eigen::Vector3f> one_far_away = random_points(700, 2, 0.01F);
  one_far_away[5] = {9e17F, -9e17F, 9e17F};
  one_far_away[6] = -one_far_away[5];
  for (const auto& points : {line, few_places, from_a_sensor, one_far_away}) {
    for (const std::size_t k : {1, 10, 64}) expect_nearest(points, k);
  }
}

TEST(NearestNeighbours, PointsThatAreNotFiniteAreNone) {
  std::vector<Eigen::Vector3f> points = random_points(300, 5, 1.0F);
  for (std::size_t i = 0; i < points.size(); i += 7) points[i].y() = std::numeric_limits<float>::quiet_NaN();
  points[1].x() = std::numeric_limits<float>::infinity();
  points[2].z() = 2e18F;  // its squares are infinite
  const NearestNeighbours found = nearest_neighbours(points, 10, Executor{});
  EXPECT_EQ(found.order.size(), 300U - 43U - 2U);
  points[2].z() = std::numeric_limits<float>::quiet_NaN();
  expect_nearest(points, 10);
}

TEST(NearestNeighbours, ManyEqualPointsTakeNoLongerThanOthers) {
  const std::vector<Eigen::Vector3f> points(200'000, Eigen::Vector3f{1.0F, 2.0F, 3.0F});
  const NearestNeighbours found = nearest_neighbours(points, 10, Executor::with_threads(2));
  ASSERT_EQ(found.nodes.size(), 2'000'000U);  // looking at all pairs would take minutes
  for (std::size_t node = 0; node < found.order.size(); node += 997) {
    const auto row = found.of(node);
    EXPECT_EQ(std::set(row.begin(), row.end()).size(), 10U);
  }
}

TEST(NearestNeighbours, AreTheSameForEveryThreadCount) {
  const std::vector<Eigen::Vector3f> points = random_points(60'000, 8, 0.1F);
  const NearestNeighbours one = nearest_neighbours(points, 10, Executor{});
  const NearestNeighbours three = nearest_neighbours(points, 10, Executor::with_threads(3));
  EXPECT_EQ(one.order, three.order);
  EXPECT_EQ(one.nodes, three.nodes);
}

TEST(NearestNeighbours, AreTheSameOnEveryInstructionSet) {
  std::vector<Eigen::Vector3f> points = random_points(5'003, 9, 0.1F);
  for (int i = 0; i < 900; ++i) points.emplace_back(static_cast<float>(i % 30), static_cast<float>(i / 30), 0.0F);
  const NearestNeighbours widest = nearest_neighbours(points, 10, Executor{});
  for (const std::string& target : simd_targets()) {
    SCOPED_TRACE(target);
    ASSERT_TRUE(use_simd_target(target).ok());
    const NearestNeighbours found = nearest_neighbours(points, 10, Executor{});
    EXPECT_EQ(found.order, widest.order);
    EXPECT_EQ(found.nodes, widest.nodes);
    expect_nearest(random_points(500, 4, 0.01F), 10);
  }
  ASSERT_TRUE(use_simd_target("").ok());
}

TEST(NearestNeighbours, OfNothingAreNone) {
  EXPECT_TRUE(nearest_neighbours({}, 10, Executor{}).order.empty());
  EXPECT_EQ(nearest_neighbours(random_points(1, 1, 1.0F), 10, Executor{}).count, 0U);
}

}  // namespace
}  // namespace saccade
