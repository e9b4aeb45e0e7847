// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/upright.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr double kDegree{std::numbers::pi / 180.0};

double angle_deg(const Vector3d& a, const Vector3d& b) {
  return std::acos(a.normalized().dot(b.normalized())) / kDegree;
}

/// A table with a box on it, z up, before its middle is moved into a camera's frame.
std::vector<Eigen::Vector3f> table(const Pose& T_frame_table) {
  std::mt19937 random{3};
  std::uniform_real_distribution<double> at{-0.5, 0.5};
  std::normal_distribution<double> noise{0.0, 0.001};
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 6000; ++i) {
    Vector3d p{at(random), at(random), noise(random)};
    if (i % 4 == 0) p = Vector3d{0.1, 0.3 * at(random), 0.3 * (at(random) + 0.5)};  // a wall of the box
    points.emplace_back((T_frame_table * p).cast<float>());
  }
  points.emplace_back(Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  return points;
}

/// A camera 1 m from the table's middle, above it by this angle.
Pose camera_above(double elevation_deg) {
  const double e = elevation_deg * kDegree;
  return look_at({0.0, -std::cos(e), std::sin(e)}, Vector3d::Zero());
}

TEST(Upright, WithoutHintsZIsUp) {
  const Upright upright = find_upright(table(Pose::Identity()));
  EXPECT_EQ(upright.source, UprightSource::none);
  EXPECT_EQ(upright.up, Vector3d::UnitZ());
  EXPECT_FALSE(upright.towards_viewer);
}

TEST(Upright, OneCamerasCloudStandsOnItsTable) {
  for (const double elevation_deg : {20.0, 35.0, 45.0}) {
    const Pose T_camera_table = camera_above(elevation_deg).inverse();
    const std::vector<Eigen::Vector3f> points = table(T_camera_table);
    ASSERT_TRUE(is_in_camera_frame(points));
    const Upright upright = find_upright(points);
    EXPECT_EQ(upright.source, UprightSource::camera_frame);
    EXPECT_LT(angle_deg(upright.up, T_camera_table.linear().col(2)), 1.0) << elevation_deg;
    EXPECT_EQ(upright.towards_viewer, -Vector3d::UnitZ());
  }
}

TEST(Upright, WithoutAPlaneACamerasDownIsDown) {
  std::mt19937 random{5};
  std::normal_distribution<float> normal;
  std::vector<Eigen::Vector3f> ball;
  for (int i = 0; i < 3000; ++i) {
    ball.emplace_back(Eigen::Vector3f{normal(random), normal(random), normal(random)}.normalized() * 0.3F +
                      Eigen::Vector3f{0.0F, 0.0F, 1.5F});
  }
  EXPECT_EQ(find_upright(ball).up, -Vector3d::UnitY());
}

TEST(Upright, AStatedDirectionGoesBeforeGravityAndThatBeforeCameras) {
  const std::vector<Eigen::Vector3f> points = table(camera_above(35.0).inverse());
  UprightHints hints;
  hints.T_world_cameras = {camera_above(35.0), camera_above(30.0)};
  EXPECT_EQ(find_upright(points, hints).source, UprightSource::cameras);
  hints.gravity = Vector3d{0.0, 2.0, 1.0};
  const Upright by_gravity = find_upright(points, hints);
  EXPECT_EQ(by_gravity.source, UprightSource::gravity);
  EXPECT_LT(angle_deg(by_gravity.up, {0.0, -2.0, -1.0}), 1e-6);
  hints.up = Vector3d{0.0, 0.0, 3.0};
  const Upright stated = find_upright(points, hints);
  EXPECT_EQ(stated.source, UprightSource::stated);
  EXPECT_EQ(stated.up, Vector3d::UnitZ());
  hints.up = Vector3d::Zero();
  EXPECT_EQ(find_upright(points, hints).source, UprightSource::gravity) << "no direction";
}

TEST(Upright, CamerasHeldUprightTellTheFloorOfAWorldThatBeganAtOne) {
  const Pose T_world_first = camera_above(30.0);
  std::vector<Pose> T_first_cameras;
  for (const double turn_deg : {-30.0, -10.0, 0.0, 20.0, 35.0}) {
    const Pose around{Eigen::AngleAxisd{turn_deg * kDegree, Vector3d::UnitZ()}};
    T_first_cameras.push_back(T_world_first.inverse() * around * T_world_first);
  }
  const std::vector<Eigen::Vector3f> points = table(T_world_first.inverse());
  const Upright upright = find_upright(points, {.T_world_cameras = T_first_cameras});
  EXPECT_EQ(upright.source, UprightSource::cameras);
  EXPECT_LT(angle_deg(upright.up, T_world_first.inverse().linear().col(2)), 1.0);
  ASSERT_TRUE(upright.towards_viewer);
  EXPECT_GT(upright.towards_viewer->dot(-Vector3d::UnitZ()), 0.8);
  EXPECT_EQ(find_upright(points, {.T_world_cameras = T_first_cameras}), upright) << "deterministic";
}

TEST(Upright, NoPointsAreNoCamerasView) {
  EXPECT_FALSE(is_in_camera_frame({}));
  EXPECT_EQ(find_upright({}).source, UprightSource::none);
}

}  // namespace
}  // namespace saccade
