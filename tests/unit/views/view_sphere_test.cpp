// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/view_sphere.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "saccade/views/view_gain.hpp"

namespace saccade {
namespace {

constexpr double kDegree{0.017453292519943295};
const Eigen::Vector3d kCenter{0.3, -0.2, 0.1};

TEST(ViewSphere, HasTheThesis960PosesInDocumentedOrder) {
  const auto candidates = view_sphere(kCenter);
  ASSERT_TRUE(candidates.ok());
  ASSERT_EQ(candidates->size(), 960U);
  for (std::size_t i = 0; i < candidates->size(); ++i) {
    const ViewCandidate& c = (*candidates)[i];
    EXPECT_NEAR(c.roll_rad, static_cast<double>(i % 8) * 45.0 * kDegree, 1e-9);
    EXPECT_NEAR(c.longitude_rad, static_cast<double>(i / 8 % 12) * 30.0 * kDegree, 1e-9);
    EXPECT_NEAR(c.latitude_rad, static_cast<double>(i / 96) * 10.0 * kDegree, 1e-9);
    EXPECT_EQ(c.radius_m, 0.8);
  }
}

TEST(ViewSphere, PosesLookAtTheCentreFromTheirPlace) {
  const auto candidates = view_sphere(kCenter);
  ASSERT_TRUE(candidates.ok());
  for (const ViewCandidate& c : *candidates) {
    const Pose& T = c.T_world_camera;
    const Eigen::Vector3d outward{std::cos(c.latitude_rad) * std::cos(c.longitude_rad),
                                  std::cos(c.latitude_rad) * std::sin(c.longitude_rad), std::sin(c.latitude_rad)};
    EXPECT_LT((T.translation() - (kCenter + 0.8 * outward)).norm(), 1e-12);
    EXPECT_LT((T * Eigen::Vector3d{0.0, 0.0, 0.8} - kCenter).norm(), 1e-12);
    EXPECT_LT((T.linear() * T.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_GT(T.linear().determinant(), 0.0);
    if (c.latitude_rad < 89.0 * kDegree) {
      const Pose expected = look_at(T.translation(), kCenter, Eigen::Vector3d::UnitZ(), c.roll_rad);
      EXPECT_LT((T.matrix() - expected.matrix()).norm(), 1e-9);
    }
  }
}

TEST(ViewSphere, LongitudesAtThePoleContinueThoseBelow) {
  ViewSphereConfig config;
  config.latitude_min_rad = 89.999 * kDegree;
  config.latitude_step_rad = 0.001 * kDegree;
  const auto candidates = view_sphere(kCenter, config);
  ASSERT_TRUE(candidates.ok());
  ASSERT_EQ(candidates->size(), 192U);
  for (std::size_t i = 0; i < 96; ++i) {
    const Eigen::Matrix3d below = (*candidates)[i].T_world_camera.linear();
    const Eigen::Matrix3d pole = (*candidates)[i + 96].T_world_camera.linear();
    EXPECT_LT((below - pole).norm(), 1e-3);
  }
}

TEST(ViewSphere, RadiiAreTheSlowestIndex) {
  ViewSphereConfig config;
  config.radii_m = {0.6, 1.0};
  config.roll_step_rad = 10.0;
  const auto candidates = view_sphere(kCenter, config);
  ASSERT_TRUE(candidates.ok());
  ASSERT_EQ(candidates->size(), 240U);
  EXPECT_EQ((*candidates)[119].radius_m, 0.6);
  EXPECT_EQ((*candidates)[120].radius_m, 1.0);
}

TEST(ViewSphere, RefusesWhatMakesNoSense) {
  const auto refused = [](auto&& change) {
    ViewSphereConfig config;
    change(config);
    const auto result = view_sphere(kCenter, config);
    return !result.ok() && result.error().code == Errc::invalid_argument;
  };
  EXPECT_TRUE(refused([](auto& c) { c.radii_m = {}; }));
  EXPECT_TRUE(refused([](auto& c) { c.radii_m = {0.8, -1.0}; }));
  EXPECT_TRUE(refused([](auto& c) { c.roll_step_rad = 0.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.latitude_step_rad = std::numeric_limits<double>::quiet_NaN(); }));
  EXPECT_TRUE(refused([](auto& c) { c.latitude_max_rad = 2.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.latitude_min_rad = 1.6; }));
  EXPECT_TRUE(refused([](auto& c) { c.longitude_step_rad = 1e-9; }));
  EXPECT_FALSE(refused([](auto&) {}));
  EXPECT_FALSE(view_sphere({0.0, std::numeric_limits<double>::infinity(), 0.0}).ok());
}

TEST(OrderViews, ByDecreasingGainThenIndex) {
  const std::vector<std::uint64_t> gains{3, 7, 0, 7, 3};
  std::vector<Pose> poses(5, Pose::Identity());
  for (std::size_t i = 0; i < 5; ++i) poses[i].translation().x() = static_cast<double>(i);
  const std::vector<OrderedView> views = order_views(gains, poses);
  ASSERT_EQ(views.size(), 5U);
  const std::size_t expected[]{1, 3, 0, 4, 2};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(views[i].index, expected[i]);
    EXPECT_EQ(views[i].gain, gains[expected[i]]);
    EXPECT_EQ(views[i].T_world_camera.translation().x(), static_cast<double>(expected[i]));
  }
}

}  // namespace
}  // namespace saccade
