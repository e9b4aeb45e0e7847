// SPDX-License-Identifier: Apache-2.0
// Which surfel a pixel sees: outlines of discs, what is in front, overlaps, threads.
#include "saccade/surfel/surfel_points.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <vector>

namespace saccade {
namespace {

constexpr PinholeCamera kViewCamera{200, 100, 200.0, 200.0, 99.5, 49.5, 0.1, 10.0};

struct ViewedDiscs {
  std::vector<Eigen::Vector3f> positions_m;
  std::vector<Eigen::Vector3f> normals;
  std::vector<float> radii_m;

  void add(const Eigen::Vector3f& p, const Eigen::Vector3f& n, float radius_m) {
    positions_m.push_back(p);
    normals.push_back(n.normalized());
    radii_m.push_back(radius_m);
  }
  [[nodiscard]] SurfelView seen(const Pose& T_world_camera = Pose::Identity(), const Executor& executor = {}) const {
    return view_surfels({positions_m, normals, radii_m}, kViewCamera, T_world_camera, executor);
  }
};

std::size_t pixels_of(const SurfelView& view, SurfelId id) {
  return static_cast<std::size_t>(std::count(view.seen.pixels().begin(), view.seen.pixels().end(), id));
}

TEST(SurfelView, AnObliqueDiscIsAnEllipse) {
  for (const float tilt_rad : {0.0F, 0.6F, 1.2F}) {
    ViewedDiscs discs;
    discs.add({0.0F, 0.0F, 2.0F}, {std::sin(tilt_rad), 0.0F, -std::cos(tilt_rad)}, 0.3F);
    const SurfelView view = discs.seen();
    // π a b with a = f r / z and b shortened; perspective adds little.
    const double expected = std::numbers::pi * 30.0 * 30.0 * std::cos(tilt_rad);
    EXPECT_NEAR(static_cast<double>(pixels_of(view, 0)), expected, 0.04 * expected) << tilt_rad;
    EXPECT_EQ(view.seen(99, 49), 0U);
    EXPECT_NEAR(view.depth(99, 49), 2.0F, 0.02F);
    EXPECT_EQ(view.seen(99, 49 - 34), kNoSurfel);
    EXPECT_EQ(view.depth(0, 0), 0.0F);
  }
}

TEST(SurfelView, TheNearerHidesAndBacksAreNotSeen) {
  ViewedDiscs discs;
  discs.add({0.0F, 0.0F, 2.0F}, {0.0F, 0.0F, -1.0F}, 0.3F);
  discs.add({0.1F, 0.0F, 1.0F}, {0.0F, 0.0F, -1.0F}, 0.05F);
  discs.add({0.0F, 0.0F, 0.7F}, {0.0F, 0.0F, 1.0F}, 0.05F);    // turned away
  discs.add({0.0F, 0.0F, -1.0F}, {0.0F, 0.0F, -1.0F}, 0.05F);  // behind
  const SurfelView view = discs.seen();
  EXPECT_EQ(view.seen(119, 49), 1U);
  EXPECT_FLOAT_EQ(view.depth(119, 49), 1.0F);
  EXPECT_EQ(view.seen(99, 49), 0U);
  EXPECT_EQ(pixels_of(view, 2) + pixels_of(view, 3), 0U);
  EXPECT_GT(pixels_of(view, 1), 250U);
}

TEST(SurfelView, OfDiscsThatOverlapTheNearestCentreIsSeen) {
  ViewedDiscs discs;
  discs.add({-0.05F, 0.0F, 2.0F}, {0.0F, 0.0F, -1.0F}, 0.2F);
  discs.add({0.05F, 0.0F, 2.02F}, {0.0F, 0.0F, -1.0F}, 0.2F);  // a little farther away
  const SurfelView view = discs.seen();
  for (int u = 92; u <= 107; ++u) EXPECT_EQ(view.seen(u, 49), u < 100 ? 0U : 1U) << u;
}

TEST(SurfelView, AMovedCameraSeesTheSame) {
  ViewedDiscs discs;
  discs.add({0.1F, 0.05F, 2.0F}, {0.3F, -0.2F, -1.0F}, 0.2F);
  const SurfelView still = discs.seen();
  const Pose T{Eigen::Translation3d{1.0, 2.0, -0.5} * Eigen::AngleAxisd{1.1, Eigen::Vector3d{1, 2, 3}.normalized()}};
  ViewedDiscs moved;
  moved.add(T.cast<float>() * discs.positions_m[0], T.linear().cast<float>() * discs.normals[0], 0.2F);
  const SurfelView view = moved.seen(T);
  std::size_t different{0};
  for (std::size_t i = 0; i < view.seen.size(); ++i)
    different += view.seen.pixels()[i] != still.seen.pixels()[i] ? 1 : 0;
  EXPECT_LE(different, 6U) << "pixels on the rim";
  EXPECT_GT(pixels_of(view, 0), 500U);
}

TEST(SurfelView, ThreadsChangeNothing) {
  ViewedDiscs discs;
  std::mt19937 random{3};
  std::uniform_real_distribution<float> in{-1.0F, 1.0F};
  for (int i = 0; i < 20000; ++i) {
    discs.add({in(random), 0.6F * in(random), 2.0F + 0.5F * in(random)}, {in(random), in(random), -1.0F},
              0.02F + 0.01F * in(random));
  }
  const SurfelView one = discs.seen();
  const SurfelView four = discs.seen(Pose::Identity(), Executor::with_threads(4));
  EXPECT_EQ(one.seen, four.seen);
  EXPECT_EQ(one.depth, four.depth);
  EXPECT_LT(pixels_of(one, kNoSurfel), one.seen.size() / 10);
}

}  // namespace
}  // namespace saccade
