// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/simulated_camera.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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

TEST(SimulatedCamera, SeesWhatStandsBeforeTheSceneAndNotWhatStandsBehind) {
  SimulatedCamera camera = camera_with(std::nullopt);
  DepthImage before{160, 120};
  before(10, 10) = 0.9F;
  before(11, 10) = 1.7F;   // below the plate
  before(12, 10) = 0.15F;  // nearer than the minimum range, 0.2 m
  const Frame frame = camera.capture(above(1.5), before);
  EXPECT_EQ(frame.depth(10, 10), 0.9F);
  EXPECT_NEAR(frame.depth(11, 10), 1.5, 1e-5);
  EXPECT_EQ(frame.depth(12, 10), 0.0F);
  EXPECT_NEAR(frame.depth(13, 10), 1.5, 1e-5);
  EXPECT_NE((*frame.color)(10, 10), (*frame.color)(11, 10));
  EXPECT_EQ((*frame.color)(12, 10), (Rgb8{0, 0, 0}));
  EXPECT_EQ((*frame.color)(13, 10), (*frame.color)(11, 10));
  EXPECT_EQ(camera.frames(), 1U);
  EXPECT_THROW((void)camera.capture(above(1.5), DepthImage{80, 60}), ContractViolation);
}

TEST(SimulatedCamera, ASceneTooNearToBeMeasuredHidesWhatIsBehindIt) {
  SimulatedCamera camera = camera_with(std::nullopt);
  const DepthImage before{160, 120, 0.5F};
  EXPECT_EQ(camera.capture(above(0.1), before).depth, (DepthImage{160, 120}));
  EXPECT_EQ(camera.capture(above(0.8), before).depth, before);
}

TEST(SimulatedCamera, NoiseFallsOnWhatStandsBeforeToo) {
  SimulatedCamera camera = camera_with(kinect_v1_noise(7));
  SimulatedCamera same = camera_with(kinect_v1_noise(7));
  EXPECT_EQ(camera.capture(above(2.0), DepthImage{160, 120}).depth, same.capture(above(2.0)).depth) << "nothing before";
  const DepthImage before{160, 120, 1.0F};
  const DepthImage depth = camera.capture(above(2.0), before).depth;
  double squares = 0.0;
  for (const float z : depth.pixels()) squares += (z - 1.0) * (z - 1.0);
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(depth.size())), DepthNoise{}.sigma_m(1.0), 5e-4);
  EXPECT_EQ(same.capture(above(2.0), before, Executor::with_threads(3)).depth, depth);
}

/// A post before a wall, 0.6 m behind it.
SimulatedCamera time_of_flight_camera(const std::optional<DepthFilterConfig>& filter) {
  Scene scene;
  scene.name = "post";
  SceneObject post;
  post.name = "post";
  post.shape = BoxShape{{0.11, 0.11, 4.0}};
  post.T_world_object = Pose{Eigen::Translation3d{1.0, 0.0, -2.0}};
  SceneObject wall;
  wall.name = "wall";
  wall.shape = BoxShape{{0.1, 20.0, 20.0}};
  wall.T_world_object = Pose{Eigen::Translation3d{1.7, 0.0, -10.0}};
  scene.objects = {post, wall};
  scene.workspace = Box{Vector3d::Constant(-2.0), Vector3d::Constant(2.0)};
  SimulatedCameraConfig config;
  config.camera = PinholeCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.2, 6.0};
  config.time_of_flight.emplace();
  config.depth_filter = filter;
  return *SimulatedCamera::create(*RayScene::build(scene), config);
}

TEST(SimulatedCamera, KnowsWhatATimeOfFlightCameraMeasuresWrongly) {
  const Pose T_world_camera = look_at(Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitZ());
  SimulatedCamera camera = time_of_flight_camera(std::nullopt);
  EXPECT_TRUE(camera.truth().empty());
  const Frame frame = camera.capture(T_world_camera);
  const TimeOfFlightFrame expected =
      capture_time_of_flight(camera.scene(), camera.camera(), TimeOfFlightConfig{}, T_world_camera).value();
  EXPECT_EQ(frame.depth, expected.depth);
  EXPECT_EQ(camera.truth(), expected.truth);
  const auto count = [&](MeasuredPixel kind) {
    const auto& pixels = camera.truth().pixels();
    return std::count(pixels.begin(), pixels.end(), kind);
  };
  EXPECT_GT(count(MeasuredPixel::in_shadow), 200);
  EXPECT_GT(count(MeasuredPixel::veil), 50);

  SimulatedCamera filtering = time_of_flight_camera(DepthFilterConfig{});
  const Frame filtered = filtering.capture(T_world_camera);
  const DepthFilter filter = DepthFilter::create(camera.camera()).value();
  EXPECT_EQ(filtered.depth, filter.filter(expected.depth).value().depth);
  EXPECT_EQ(filtering.truth(), expected.truth);
}

TEST(SimulatedCamera, WhatStandsBeforeATimeOfFlightCameraThrowsNoShadow) {
  const Pose T_world_camera = look_at(Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitZ());
  SimulatedCamera camera = time_of_flight_camera(std::nullopt);
  SimulatedCamera same = time_of_flight_camera(std::nullopt);
  DepthImage before{160, 120};
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 40; ++u) before(u, v) = 0.5F;
  }
  const Frame frame = camera.capture(T_world_camera, before);
  const Frame without = same.capture(T_world_camera);
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      if (u < 40) {
        ASSERT_NEAR(frame.depth(u, v), 0.5F, 0.02F);
        ASSERT_EQ(camera.truth()(u, v), MeasuredPixel::good);
      } else if (u > 41) {
        ASSERT_EQ(frame.depth(u, v), without.depth(u, v)) << u << ", " << v;
      }
    }
  }
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
