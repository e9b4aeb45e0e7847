// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/simulated_camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace saccade {
namespace {

using Eigen::Vector3d;

/// A wide plate, seen from above at a distance.
RayScene plate() {
  Scene scene;
  scene.name = "plate";
  SceneObject object;
  object.name = "plate";
  object.shape = BoxShape{{20.0, 20.0, 0.1}};
  scene.objects = {object};
  scene.workspace = Box{Vector3d::Constant(-2.0), Vector3d::Constant(2.0)};
  return *RayScene::build(scene);
}
Pose above(double height_m) { return look_at({0.0, 0.001, 0.1 + height_m}, {0.0, 0.001, 0.0}, Vector3d::UnitY()); }

SimulatedCamera camera_with(const std::optional<DepthNoise>& noise) {
  SimulatedCameraConfig config;
  config.camera = PinholeCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.2, 6.0};
  config.noise = noise;
  return *SimulatedCamera::create(plate(), config);
}

TEST(SimulatedCamera, WithoutNoiseDepthIsExact) {
  SimulatedCamera camera = camera_with(std::nullopt);
  const Frame frame = camera.capture(above(1.5));
  for (const float z : frame.depth.pixels()) EXPECT_NEAR(z, 1.5, 1e-5);
  ASSERT_TRUE(frame.color);
  EXPECT_EQ(frame.color->width(), 160);
}

TEST(SimulatedCamera, AxialNoiseHasTheSigmaItIsGiven) {
  DepthNoise noise;  // axial alone
  SimulatedCamera camera = camera_with(noise);
  for (const double height_m : {0.8, 1.6, 3.2}) {
    const Frame frame = camera.capture(above(height_m));
    double sum = 0.0;
    double squares = 0.0;
    for (const float z : frame.depth.pixels()) {
      sum += z - height_m;
      squares += (z - height_m) * (z - height_m);
    }
    const auto n = static_cast<double>(frame.depth.size());
    const double sigma = noise.sigma_m(height_m);
    EXPECT_NEAR(sum / n, 0.0, 4.0 * sigma / std::sqrt(n)) << height_m;
    EXPECT_NEAR(std::sqrt(squares / n) / sigma, 1.0, 4.0 / std::sqrt(2.0 * n)) << height_m;
  }
}

TEST(SimulatedCamera, DepthComesInDisparitySteps) {
  SimulatedCamera camera = camera_with(kinect_v1_noise());
  const Frame frame = camera.capture(above(2.0));
  std::set<float> levels{frame.depth.pixels().begin(), frame.depth.pixels().end()};
  levels.erase(0.0F);
  EXPECT_LT(levels.size(), 10U);
  EXPECT_GT(levels.size(), 1U);
  for (const float z : levels) EXPECT_NEAR(348.0 / z, std::nearbyint(348.0 / z), 1e-3);
}

TEST(SimulatedCamera, GrazingReturnsAreLostFromTheAngleOn) {
  DepthNoise noise;
  noise.grazing_from_rad = 60.0 * M_PI / 180.0;
  SimulatedCamera camera = camera_with(noise);
  const Pose T_world_camera = look_at({0.0, 0.0, 0.7}, {2.0, 0.0, 0.1});
  const ExactFrame exact = camera.scene().render(camera.camera(), T_world_camera);
  const Frame frame = camera.capture(T_world_camera);
  int steep = 0;
  int grazing = 0;
  int lost = 0;
  double expected = 0.0;
  for (std::size_t i = 0; i < exact.depth.size(); ++i) {
    if (!(exact.depth.data()[i] > 0.0F)) continue;
    const double degrees = std::acos(exact.incidence_cosine.data()[i]) * 180.0 / M_PI;
    if (degrees < 60.0) {
      ++steep;
      EXPECT_GT(frame.depth.data()[i], 0.0F);
    } else {
      ++grazing;
      expected += (degrees - 60.0) / 30.0;
      lost += frame.depth.data()[i] == 0.0F ? 1 : 0;
    }
  }
  EXPECT_GT(steep, 500);
  EXPECT_GT(grazing, 5000);
  EXPECT_NEAR(lost, expected, 4.0 * std::sqrt(expected));
}

TEST(SimulatedCamera, WhatLiesBeyondTheRangeShowsFreeSpace) {
  SimulatedCameraConfig config;
  config.camera = PinholeCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.2, 1.5};
  config.reach_m = 2.5;
  SimulatedCamera camera = *SimulatedCamera::create(plate(), config);
  EXPECT_EQ(camera.capture(above(2.0)).depth, (DepthImage{160, 120, -1.5F}));
  EXPECT_EQ(camera.capture(above(3.0)).depth, (DepthImage{160, 120}));
  const DepthImage near = camera.capture(above(1.0)).depth;
  for (const float z : near.pixels()) EXPECT_GT(z, 0.9F);
}

TEST(SimulatedCamera, SeedsAndFrameNumbersDecideTheNoise) {
  SimulatedCamera one = camera_with(kinect_v1_noise(7));
  SimulatedCamera same = camera_with(kinect_v1_noise(7));
  SimulatedCamera other = camera_with(kinect_v1_noise(8));
  const Frame first = one.capture(above(2.0));
  const Frame second = one.capture(above(2.0));
  EXPECT_EQ(second.index, 1U);
  EXPECT_NE(first.depth, second.depth);
  EXPECT_EQ(first.depth, same.capture(above(2.0), Executor::with_threads(3)).depth);
  EXPECT_NE(first.depth, other.capture(above(2.0)).depth);
  same.resume_at(1);
  EXPECT_EQ(second.depth, same.capture(above(2.0)).depth);
}

TEST(SimulatedCamera, RefusesABadCameraOrNoise) {
  SimulatedCameraConfig config;
  config.noise->dropout = 2.0;
  EXPECT_FALSE(SimulatedCamera::create(plate(), config));
  config = {};
  config.camera.width = 0;
  EXPECT_FALSE(SimulatedCamera::create(plate(), config));
}

}  // namespace
}  // namespace saccade
