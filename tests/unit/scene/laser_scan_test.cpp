// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/laser_scan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "saccade/scene/scene_yaml.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

/// A post of two boxes, one segment, in the middle of a floor of 8 m.
RayScene post() {
  Scene scene;
  scene.name = "post";
  scene.workspace = {{-4, -4, -1}, {4, 4, 3}};
  SceneObject floor;
  floor.name = "floor";
  floor.shape = BoxShape{{8, 8, 0.2}};
  floor.T_world_object.translation() = Vector3d{0, 0, -0.2};
  scene.objects.push_back(floor);
  for (const double z : {0.0, 0.5}) {
    SceneObject part;
    part.name = z > 0.0 ? "upper" : "lower";
    part.shape = BoxShape{{1, 1, 0.5}};
    part.T_world_object.translation() = Vector3d{2, 0, z};
    part.segment = "post";
    part.color = {200, 20, 20};
    scene.objects.push_back(part);
  }
  auto rays = RayScene::build(std::move(scene));
  EXPECT_TRUE(rays);
  return *std::move(rays);
}

LaserScanConfig exact_config() {
  LaserScanConfig config;
  config.stations_m = {{0, 0, 1.2}, {0, 3, 1.2}};
  config.step_rad = 0.02;
  config.range_noise_m = 0.0;
  config.color_noise = 0.0;
  config.beam_rad = 0.0;
  return config;
}

TEST(LaserScan, WithoutNoisePointsLieOnTheirSegments) {
  const RayScene scene = post();
  const auto scan = scan_by_laser(scene, exact_config());
  ASSERT_TRUE(scan) << scan.error().to_string();
  ASSERT_EQ(scan->names, (std::vector<std::string>{"", "floor", "post"}));
  ASSERT_GT(scan->labels.size(), 5000U);
  std::size_t on_post = 0;
  for (std::size_t i = 0; i < scan->labels.size(); ++i) {
    const Eigen::Vector3f& p = scan->cloud.positions_m[i];
    if (scan->labels[i] == 1) {
      EXPECT_NEAR(p.z(), 0.0F, 1e-5F);
      continue;
    }
    ASSERT_EQ(scan->labels[i], 2U);
    ++on_post;
    EXPECT_GE(p.x(), 1.5F - 1e-5F);
    EXPECT_LE(p.x(), 2.5F + 1e-5F);
    EXPECT_LE(std::abs(p.y()), 0.5F + 1e-5F);
    EXPECT_GT(p.z(), -1e-5F);
    EXPECT_LE(p.z(), 1.0F + 1e-5F);
    EXPECT_GT(scan->cloud.colors[i].x(), 4.0F * scan->cloud.colors[i].y());
    EXPECT_FALSE(p.x() > 2.5F - 1e-5F && p.z() < 1.0F - 1e-5F) << "the far side cannot be seen";
  }
  EXPECT_GT(on_post, 300U);
}

TEST(LaserScan, NoiseIsAlongTheRayAndOfItsSeed) {
  const RayScene scene = post();
  LaserScanConfig config = exact_config();
  const auto exact = scan_by_laser(scene, config);
  config.range_noise_m = 0.01;
  config.color_noise = 0.05;
  const auto noisy = scan_by_laser(scene, config, Executor::with_threads(1));
  const auto again = scan_by_laser(scene, config, Executor::with_threads(3));
  config.seed = 2;
  const auto other = scan_by_laser(scene, config);
  ASSERT_TRUE(exact && noisy && again && other);
  ASSERT_EQ(noisy->cloud.positions_m.size(), exact->cloud.positions_m.size());
  EXPECT_EQ(noisy->cloud.positions_m, again->cloud.positions_m);
  EXPECT_EQ(noisy->cloud.colors, again->cloud.colors);
  EXPECT_NE(noisy->cloud.positions_m, other->cloud.positions_m);
  double squares = 0.0;
  const std::size_t half = exact->labels.size() / 4;  // rays of the first station
  for (std::size_t i = 0; i < half; ++i) {
    const Vector3d station = config.stations_m.front();
    const Vector3d to_exact = exact->cloud.positions_m[i].cast<double>() - station;
    const Vector3d to_noisy = noisy->cloud.positions_m[i].cast<double>() - station;
    EXPECT_LT(to_exact.normalized().cross(to_noisy).norm(), 1e-5);
    squares += std::pow(to_noisy.norm() - to_exact.norm(), 2);
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(half)), 0.01, 0.001);
}

TEST(LaserScan, BeamAtAnEdgeMeetsBothSurfaces) {
  const RayScene scene = post();
  LaserScanConfig config = exact_config();
  config.step_rad = 0.01;
  config.beam_rad = 0.01;
  const auto scan = scan_by_laser(scene, config);
  ASSERT_TRUE(scan);
  const auto in_between = [](const Eigen::Vector3f& p) {
    const bool in_post = p.x() > 1.501F && p.x() < 2.499F && std::abs(p.y()) < 0.499F && p.z() < 0.999F;
    return p.z() > 0.01F && !in_post && (p.x() < 1.499F || p.x() > 2.501F || std::abs(p.y()) > 0.501F);
  };
  EXPECT_GT(std::count_if(scan->cloud.positions_m.begin(), scan->cloud.positions_m.end(), in_between), 10);
}

TEST(LaserScan, BadConfigurationsAreRefused) {
  const RayScene scene = post();
  const auto refused = [&](auto change) {
    LaserScanConfig config = exact_config();
    change(config);
    const auto scan = scan_by_laser(scene, config);
    return !scan && scan.error().code == Errc::invalid_argument;
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refused([](auto& c) { c.stations_m.clear(); }));
  EXPECT_TRUE(refused([](auto& c) { c.stations_m[0].x() = kNan; }));
  EXPECT_TRUE(refused([](auto& c) { c.stations_m.assign(65, Vector3d::Zero()); }));
  EXPECT_TRUE(refused([](auto& c) { c.step_rad = 1e-6; }));
  EXPECT_TRUE(refused([](auto& c) { c.step_rad = kNan; }));
  EXPECT_TRUE(refused([](auto& c) { c.max_range_m = c.min_range_m; }));
  EXPECT_TRUE(refused([](auto& c) { c.range_noise_m = -1.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.lowest_rad = 2.0; }));
}

TEST(RandomScenes, RoomsAndStreetsAreSoundAndDiffer) {
  std::set<std::string> hashes;
  for (const char* kind : {"room:", "street:"}) {
    for (int seed = 1; seed <= 6; ++seed) {
      const std::string name = kind + std::to_string(seed);
      const auto scene = find_scene(name);
      ASSERT_TRUE(scene) << scene.error().to_string();
      ASSERT_TRUE(scene->validate().ok()) << name << ": " << scene->validate().error().to_string();
      EXPECT_GE(scene->scan.size(), 2U);
      const SegmentTable segments{*scene};
      EXPECT_GE(segments.names().size(), 20U) << name;
      if (seed > 2) continue;  // tessellating takes longer
      const auto rays = RayScene::build(*scene);
      ASSERT_TRUE(rays);
      hashes.insert(scene_hash(*rays));
      for (const Pose& pose : scene->scan) {  // the scanner stands free
        const auto below = rays->cast(pose.translation(), -Vector3d::UnitZ());
        ASSERT_TRUE(below);
        EXPECT_LT(below->normal_world.dot(-Vector3d::UnitZ()), 0.0) << name << ": a station is in a body";
      }
    }
  }
  EXPECT_EQ(hashes.size(), 4U);
  EXPECT_FALSE(find_scene("room:x"));
}

}  // namespace
}  // namespace saccade
