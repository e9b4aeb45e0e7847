// SPDX-License-Identifier: Apache-2.0
// Gains of scenes whose answer is known, and what evaluate_views refuses.
#include "saccade/views/view_gain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "saccade/views/sensor_rays.hpp"
#include "saccade/views/view_sphere.hpp"

namespace saccade {
namespace {

constexpr double kVoxel_m{0.02};
const Executor kExecutor{};

TsdfMap free_map(const Box& box, const TsdfConfig& config) {
  auto map = TsdfMap::create(config);
  EXPECT_TRUE(map.ok());
  EXPECT_TRUE(map->free(box).ok());
  return std::move(map).value();
}
TsdfConfig coarse() {
  TsdfConfig config;
  config.voxel_size_m = kVoxel_m;
  return config;
}
Box cube(double half_m) { return {Eigen::Vector3d::Constant(-half_m), Eigen::Vector3d::Constant(half_m)}; }
/// One metre before the origin along z, looking at it; its rays run through the middle of voxels' faces.
Pose in_front() {
  Pose T{Pose::Identity()};
  T.translation() = Eigen::Vector3d{0.003, 0.003, -1.0};
  return T;
}
GainConfig narrow() {
  GainConfig config;
  config.sensor = {101, 101, 100.0, 100.0, 50.0, 50.0, 0.5, 6.0};
  return config;
}
std::uint64_t gain(const TsdfMap& map, const Region& region, const Pose& pose, const GainConfig& config) {
  const auto result = evaluate_views(map.snapshot(), region, std::span{&pose, 1}, config, kExecutor);
  EXPECT_TRUE(result.ok());
  return result.ok() ? result->gains.front() : ~std::uint64_t{0};
}

TEST(SensorRays, AreThePixelsOfTheCameraWhateverTheQuarterTurn) {
  const auto candidates = view_sphere({0.3, -0.2, 0.1});
  const PinholeCamera camera{64, 48, 60.0, 70.0, 30.0, 20.0, 0.5, 6.0};
  bool turned[4]{};
  for (std::size_t i = 0; i < candidates->size(); i += 7) {
    const Pose& T = (*candidates)[i].T_world_camera;
    const SensorRays rays = sensor_rays(T, kVoxel_m);
    turned[rays.quarter_turns] = true;
    for (const auto& [u, v] : {std::pair{0, 0}, std::pair{63, 0}, std::pair{5, 47}, std::pair{40, 30}}) {
      const LatticeRay ray = pixel_ray(rays, camera, u, v);
      const Eigen::Vector3d d = T.linear() * camera.ray(u, v) / kVoxel_m;
      EXPECT_LT((Eigen::Vector3f{ray.d[0], ray.d[1], ray.d[2]} - d.cast<float>()).norm(), 1e-4F);
      const Eigen::Vector3d o{static_cast<double>(ray.o[0]), static_cast<double>(ray.o[1]),
                              static_cast<double>(ray.o[2])};
      const Eigen::Vector3d origin = Eigen::Vector3d(ray.origin.x, ray.origin.y, ray.origin.z) + o;
      EXPECT_LT((origin - T.translation() / kVoxel_m).norm(), 1e-4);
    }
    // Every pixel occurs once among the canonical axes.
    const PixelAxes axes = pixel_axes(camera, rays.quarter_turns);
    EXPECT_EQ(axes.a.size() * axes.b.size(), 64U * 48U);
    EXPECT_TRUE(std::is_sorted(axes.a.begin(), axes.a.end()) && std::is_sorted(axes.b.begin(), axes.b.end()));
  }
  EXPECT_TRUE(turned[0] && turned[1] && turned[2] && turned[3]);
}

TEST(SensorRays, RollsByQuarterTurnsAndThePoleShareTheirLattice) {
  const auto candidates = view_sphere({0.3, -0.2, 0.1});
  for (std::size_t i = 0; i < candidates->size(); ++i) {
    const std::size_t quarter = i / 8 * 8 + (i + 2) % 8;
    EXPECT_TRUE(sensor_rays((*candidates)[i].T_world_camera, kVoxel_m)
                    .same_lattice(sensor_rays((*candidates)[quarter].T_world_camera, kVoxel_m)))
        << i;
  }
  const SensorRays pole = sensor_rays((*candidates)[9 * 96].T_world_camera, kVoxel_m);
  EXPECT_TRUE(pole.same_lattice(sensor_rays((*candidates)[9 * 96 + 3 * 8].T_world_camera, kVoxel_m)))
      << "longitudes 0 and 90 degrees";
}

TEST(ViewGain, CountsThePixelsThatSeeAnUnknownBox) {
  TsdfMap map = free_map(cube(1.5), coarse());
  const Box target{{-0.2, -0.2, 0.0}, {0.2, 0.2, 0.4}};
  ASSERT_TRUE(map.forget(target).ok());
  // The near face, 0.4 m wide and 1 m away, moved by the camera's 3 mm: |u - 50 + 0.3| < 20.
  EXPECT_EQ(gain(map, target, in_front(), narrow()), 40U * 40U);

  GainConfig distinct = narrow();
  distinct.count = GainCount::distinct_voxels;
  EXPECT_EQ(gain(map, target, in_front(), distinct), 20U * 20U) << "the voxels of the near face";
}

TEST(ViewGain, OccludersAndTheSensorsRangeBlock) {
  TsdfMap map = free_map(cube(1.5), coarse());
  const Box target{{-0.2, -0.2, 0.0}, {0.2, 0.2, 0.4}};
  ASSERT_TRUE(map.forget(target).ok());
  GainConfig config = narrow();
  config.sensor.min_range_m = 1.1;
  EXPECT_EQ(gain(map, target, in_front(), config), 0U) << "nearer than the minimum range";
  config = narrow();
  config.sensor.max_range_m = 0.9;
  EXPECT_EQ(gain(map, target, in_front(), config), 0U) << "farther than the maximum range";

  const Box unknown_in_front{{-0.5, 0.0, -0.4}, {0.5, 0.5, -0.3}};
  ASSERT_TRUE(map.forget(unknown_in_front).ok());
  const std::uint64_t half = gain(map, target, in_front(), narrow());
  EXPECT_GT(half, 700U);
  EXPECT_LT(half, 900U);
  config = narrow();
  config.unknown_outside = UnknownOutside::transparent;
  EXPECT_EQ(gain(map, target, in_front(), config), 40U * 40U);
}

TEST(ViewGain, OutsideTheWorkspaceNothingIsUnknown) {
  const Box target{{-0.2, -0.2, 0.0}, {0.2, 0.2, 0.4}};
  TsdfConfig config = coarse();
  config.workspace = cube(0.5);
  TsdfMap map = free_map(*config.workspace, config);
  ASSERT_TRUE(map.forget(target).ok());
  EXPECT_EQ(gain(map, target, in_front(), narrow()), 40U * 40U) << "the camera stands outside the workspace";
  TsdfMap unbounded = free_map(cube(0.5), coarse());
  ASSERT_TRUE(unbounded.forget(target).ok());
  EXPECT_EQ(gain(unbounded, target, in_front(), narrow()), 0U) << "the camera is in unknown space";
}

TEST(ViewGain, TiltShowsMoreAboveAndBelow) {
  TsdfMap map = free_map(cube(1.5), coarse());
  const Box tall{{-0.1, -0.7, 0.0}, {0.1, 0.7, 0.2}};
  ASSERT_TRUE(map.forget(tall).ok());
  GainConfig config = narrow();
  const std::uint64_t level = gain(map, tall, in_front(), config);
  config.tilt_rad = 0.0873;
  EXPECT_GT(gain(map, tall, in_front(), config), level + level / 10);
}

TEST(ViewGain, AnObservedRegionIsDoneAndAFarPoseSeesNothing) {
  const TsdfMap map = free_map(cube(1.5), coarse());
  const Region region{Sphere{Eigen::Vector3d::Zero(), 0.2}};
  EXPECT_EQ(gain(map, region, in_front(), narrow()), 0U);
  Pose far{Pose::Identity()};
  far.translation().z() = -1e6;
  EXPECT_EQ(gain(map, region, far, narrow()), 0U);
  const auto none = evaluate_views(map.snapshot(), region, {}, narrow(), kExecutor);
  ASSERT_TRUE(none.ok());
  EXPECT_TRUE(none->gains.empty());
}

NoGain no_gain(const TsdfMap& map, const Region& region, const Pose& pose) {
  const auto result = evaluate_views(map.snapshot(), region, std::span{&pose, 1}, narrow(), kExecutor);
  return result.ok() ? result->no_gain : NoGain::no_poses;
}
Pose at(double z_m) {
  Pose T{in_front()};
  T.translation().z() = z_m;
  return T;
}

TEST(ViewGain, TellsWhyNoPoseGainsAnything) {
  const Region region{Sphere{Eigen::Vector3d::Zero(), 0.2}};
  TsdfMap map = free_map(cube(1.5), coarse());
  EXPECT_EQ(no_gain(map, region, in_front()), NoGain::nothing_unknown);
  ASSERT_TRUE(map.forget(region).ok());
  EXPECT_EQ(no_gain(map, region, in_front()), NoGain::some_gain);
  EXPECT_EQ(no_gain(map, region, at(-50.0)), NoGain::out_of_range);
  EXPECT_EQ(no_gain(map, region, at(1.0)), NoGain::out_of_sight) << "it looks away";
  EXPECT_EQ(no_gain(map, region, at(0.0)), NoGain::cameras_in_unknown);
  EXPECT_EQ(evaluate_views(map.snapshot(), region, {}, narrow(), kExecutor)->no_gain, NoGain::no_poses);

  // A map without a workspace is unknown around its cameras.
  EXPECT_EQ(no_gain(*TsdfMap::create(coarse()), region, in_front()), NoGain::cameras_in_unknown);
  TsdfConfig config = coarse();
  config.workspace = cube(0.5);
  EXPECT_EQ(no_gain(*TsdfMap::create(config), region, in_front()), NoGain::out_of_sight) << "unknown voxels hide it";
  EXPECT_EQ(no_gain(*TsdfMap::create(config), cube(0.5), in_front()), NoGain::some_gain);
  EXPECT_EQ(no_gain(*TsdfMap::create(config), Sphere{{2.0, 0.0, 0.0}, 0.2}, in_front()), NoGain::outside_workspace);

  // One camera stands on the surface that it has just seen, the other in what lies behind.
  const PinholeCamera camera = narrow().sensor;
  TsdfMap seen = *TsdfMap::create(coarse());
  ASSERT_TRUE(seen.integrate(camera, DepthImage{camera.width, camera.height, 1.0F}, at(-1.5), kExecutor).ok());
  const std::vector<Pose> poses{at(-0.495), at(0.0)};
  EXPECT_EQ(evaluate_views(seen.snapshot(), region, poses, narrow(), kExecutor)->no_gain, NoGain::cameras_blocked);
  for (const NoGain reason :
       {NoGain::no_poses, NoGain::outside_workspace, NoGain::nothing_unknown, NoGain::out_of_range,
        NoGain::cameras_in_unknown, NoGain::cameras_blocked, NoGain::out_of_sight}) {
    EXPECT_NE(advice(reason).find(": "), std::string_view::npos) << "says what is wrong, and what to do";
  }
}

TEST(ViewGain, RefusesWhatMakesNoSense) {
  const TsdfMap map = free_map(cube(0.5), coarse());
  const auto code = [&](const Region& region, const Pose& pose, const GainConfig& config) {
    const auto result = evaluate_views(map.snapshot(), region, std::span{&pose, 1}, config, kExecutor);
    return result.ok() ? std::string{"ok"} : std::string{to_string(result.error().code)};
  };
  const std::string refused{to_string(Errc::invalid_argument)};
  const Region sphere{Sphere{Eigen::Vector3d::Zero(), 0.2}};
  EXPECT_EQ(code(sphere, in_front(), narrow()), "ok");
  EXPECT_EQ(code(Sphere{Eigen::Vector3d::Zero(), -0.2}, in_front(), narrow()), refused);
  EXPECT_EQ(code(Sphere{Eigen::Vector3d::Constant(1e12), 0.2}, in_front(), narrow()), refused);
  EXPECT_EQ(code(cube(1e5), in_front(), narrow()), refused) << "more voxels than can be tabulated";
  Pose bad = in_front();
  bad.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code(sphere, bad, narrow()), refused);
  bad = in_front();
  bad.linear() *= 1.1;
  EXPECT_EQ(code(sphere, bad, narrow()), refused);
  GainConfig config = narrow();
  config.sensor.fx = 0.0;
  EXPECT_EQ(code(sphere, in_front(), config), refused);
  config = narrow();
  config.tilt_rad = 1.5;
  EXPECT_EQ(code(sphere, in_front(), config), refused);
  config = narrow();
  config.sensor.max_range_m = 1e7;
  EXPECT_EQ(code(sphere, in_front(), config), refused);
}

TEST(ViewGain, ReportsProgressAndStopsWhenAsked) {
  TsdfMap map = free_map(cube(1.5), coarse());
  const Region region{Sphere{Eigen::Vector3d::Zero(), 0.2}};
  ASSERT_TRUE(map.forget(region).ok());
  const std::vector<Pose> poses = poses_of(*view_sphere(Eigen::Vector3d::Zero()));
  std::size_t last{0};
  std::size_t total{0};
  const Progress watched{[&](std::string_view, std::size_t done, std::size_t of) {
    EXPECT_EQ(done, last + 1);
    last = done;
    total = of;
  }};
  const auto result = evaluate_views(map.snapshot(), region, poses, {}, Executor::with_threads(2), watched);
  ASSERT_TRUE(result.ok());
  EXPECT_GT(total, 0U);
  EXPECT_EQ(last, total);
  EXPECT_EQ(result->rays_total, 960U * 640U * 480U);
  EXPECT_GT(result->gains[0], 0U);

  Progress cancelled;
  cancelled.request_cancel();
  const auto stopped = evaluate_views(map.snapshot(), region, poses, {}, kExecutor, cancelled);
  ASSERT_FALSE(stopped.ok());
  EXPECT_EQ(stopped.error().code, Errc::cancelled);
}

}  // namespace
}  // namespace saccade
