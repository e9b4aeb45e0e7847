// SPDX-License-Identifier: Apache-2.0
// The kernels of the GPU, run on the host, against the map and the gains of the CPU: to the bit.
#include "saccade/cuda/gpu_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "saccade/cuda/internal/gpu_map_impl.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/views/view_gain.hpp"
#include "support/effort.hpp"
#include "support/parallel_backend.hpp"
#include "support/random_map.hpp"
#include "support/random_run.hpp"

namespace saccade {
namespace {

constexpr int kFusionRuns{test::scaled_cases(4)};
constexpr int kFrames{3};
constexpr int kGainRuns{test::scaled_cases(16)};

Executor two_threads() { return Executor::with_threads(2, test::kParallelBackend); }

/// A device whose threads run in another order for each number, since a GPU promises none.
GpuMap map_in_order(const TsdfConfig& config, std::uint32_t order) {
  using internal::cuda::HostCompute;
  return internal::cuda::GpuMapMaker::make(config,
                                           std::make_unique<HostCompute>(two_threads(), ~std::size_t{0}, order));
}

TEST(GpuMap, FusesToTheBit) {
  std::size_t bricks{0};
  std::size_t dense{0};
  for (std::uint32_t seed = 1; seed <= kFusionRuns; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::RandomRun run = test::RandomRun::with_clearing(seed);
    TsdfMap expected = TsdfMap::create(run.config()).value();
    GpuMap map = map_in_order(run.config(), seed - 1);
    for (int frame = 0; frame < kFrames; ++frame) {
      const DepthImage depth = run.depth();
      const Pose T_world_camera = run.pose();
      for (int repeats = run.integer(1, 3); repeats > 0; --repeats) {
        const auto stats = expected.integrate(run.camera(), depth, T_world_camera, {});
        const auto gpu_stats = map.integrate(run.camera(), depth, T_world_camera);
        ASSERT_TRUE(gpu_stats.ok()) << gpu_stats.error().to_string();
        EXPECT_EQ(gpu_stats->valid_pixels, stats.value().valid_pixels);
      }
      const TsdfSnapshot content = map.snapshot().value();
      ASSERT_TRUE(content.grid == expected.content().grid) << "frame " << frame;
    }
    bricks += expected.content().grid.usage().bricks();
    dense += expected.content().grid.usage().dense_bricks;
  }
  EXPECT_GT(bricks, static_cast<std::size_t>(kFusionRuns) * 50);
  EXPECT_GT(dense, static_cast<std::size_t>(kFusionRuns) * 10);
}

TEST(GpuMap, KeepsWhatItIsGivenAndGoesOn) {
  for (std::uint32_t seed = 1; seed <= kFusionRuns; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::RandomRun run{seed};
    TsdfMap expected = TsdfMap::create(run.config()).value();
    const DepthImage first = run.depth();
    const Pose T_world_camera = run.pose();
    ASSERT_TRUE(expected.integrate(run.camera(), first, T_world_camera, {}).ok());
    ASSERT_TRUE(expected.free(run.region()).ok());
    ASSERT_TRUE(expected.forget(run.region()).ok());
    GpuMap map = GpuMap::create_emulated(run.config(), {}).value();
    ASSERT_TRUE(map.assign(expected.snapshot()).ok());
    EXPECT_TRUE(map.snapshot().value().grid == expected.content().grid);
    const DepthImage second = run.depth();
    const Pose T_other = run.pose();
    ASSERT_TRUE(expected.integrate(run.camera(), second, T_other, {}).ok());
    ASSERT_TRUE(map.integrate(run.camera(), second, T_other).ok());
    EXPECT_TRUE(map.snapshot().value().grid == expected.content().grid);
  }
}

/// Poses around the origin, some of them rolled by quarter turns.
std::vector<Pose> poses_of(test::RandomRun& run, int count) {
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    poses.push_back(run.pose());
    if (i % 3 != 0) continue;
    Pose rolled = poses.back();
    rolled.linear() = rolled.linear() * Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ());
    poses.push_back(rolled);
  }
  return poses;
}

TEST(GpuMap, GainsEqualThoseOfTheCpuToTheRay) {
  std::uint64_t gained{0};
  int compared{0};
  for (std::uint32_t seed = 1; seed <= kGainRuns; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::RandomMap random{seed};
    for (int step = 0; step < 4; ++step) random.step();
    TsdfSnapshot map = random.snapshot();
    test::RandomRun& run = random.run();
    if (seed % 3 == 0) {
      const Eigen::Vector3d half = Eigen::Vector3d::Constant(run.uniform(0.3, 1.5) * run.extent());
      map.config.workspace = Box{-half, half};
    }
    Region region = run.region();
    while (std::holds_alternative<Cylinder>(region)) region = run.region();
    GainConfig config;
    config.sensor = run.camera();
    config.tilt_rad = seed % 5 == 0 ? 0.05 : 0.0;
    config.unknown_outside = seed % 2 == 0 ? UnknownOutside::blocks : UnknownOutside::transparent;
    const std::vector<Pose> poses = poses_of(run, 12);
    GpuMap gpu = map_in_order(map.config, seed - 1);
    ASSERT_TRUE(gpu.assign(map).ok());
    const GainResult expected = evaluate_views(map, region, poses, config, {}).value();
    const auto result = gpu.evaluate_views(region, poses, config, two_threads());
    ASSERT_TRUE(result.ok()) << result.error().to_string();
    ASSERT_EQ(result->gains, expected.gains);
    EXPECT_EQ(result->no_gain, expected.no_gain);
    EXPECT_EQ(result->rays_total, expected.rays_total);
    for (const std::uint64_t gain : expected.gains) gained += gain > 0 ? 1 : 0;
    compared += static_cast<int>(poses.size());
  }
  EXPECT_GT(gained, static_cast<std::uint64_t>(compared) / 8);
}

/// There are more windows of one tile than tiles between two of the hints from the host, and poses that share windows.
TEST(GpuMap, GainsOfManySmallWindowsEqualThoseOfTheCpu) {
  test::RandomMap random{7};
  for (int step = 0; step < 4; ++step) random.step();
  const TsdfSnapshot map = random.snapshot();
  const double extent = random.run().extent();
  const Region region{Sphere{Eigen::Vector3d::Zero(), 0.3 * extent}};
  GainConfig config;
  config.sensor = PinholeCamera{8, 8, 8.0, 8.0, 3.5, 3.5, 0.0, 4.0 * extent};
  std::vector<Pose> poses;
  for (int i = 0; i < 400; ++i) {
    poses.push_back(random.run().pose());
    if (i % 5 == 0) poses.push_back(poses.back());
  }
  GpuMap gpu = map_in_order(map.config, 3);
  ASSERT_TRUE(gpu.assign(map).ok());
  const GainResult expected = evaluate_views(map, region, poses, config, {}).value();
  const GainResult result = gpu.evaluate_views(region, poses, config, two_threads()).value();
  EXPECT_EQ(result.gains, expected.gains);
  EXPECT_GT(std::count_if(result.gains.begin(), result.gains.end(), [](std::uint64_t gain) { return gain > 0; }), 20);
  EXPECT_GT(result.rays_cast, 100U * 64U);
  EXPECT_LE(result.rays_cast, 400U * 64U) << "equal poses share a window";
}

TEST(GpuMap, QuarterTurnsShareTheirRays) {
  TsdfConfig map;
  map.voxel_size_m = 0.02;
  GpuMap gpu = GpuMap::create_emulated(map, {}).value();
  GainConfig config;
  config.sensor = PinholeCamera{32, 32, 30.0, 30.0, 15.5, 15.5, 0.1, 2.0};
  const Region region{Sphere{{0.0, 0.0, 1.0}, 0.2}};
  std::vector<Pose> poses{Pose::Identity()};
  const std::uint64_t alone = gpu.evaluate_views(region, poses, config, {}).value().rays_cast;
  for (int turns = 1; turns < 4; ++turns) {
    Eigen::Matrix3d quarter;
    quarter << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
    poses.push_back(poses.back());
    poses.back().linear() = quarter * poses.back().linear();
  }
  const GainResult result = gpu.evaluate_views(region, poses, config, {}).value();
  EXPECT_GT(alone, 0U);
  EXPECT_EQ(result.rays_cast, alone);
  EXPECT_EQ(result.gains, evaluate_views({map, {}}, region, poses, config, {}).value().gains);
}

TEST(GpuMap, SurfaceBricksAreMarkedOnceForEachChange) {
  test::RandomRun run{3};
  GpuMap gpu = GpuMap::create_emulated(run.config(), {}).value();
  TsdfMap cpu = TsdfMap::create(run.config()).value();
  const PinholeCamera camera = run.camera();
  const Pose T_world_camera = run.pose();
  const auto kernels_of_cast = [&] {
    const std::uint64_t before = gpu.traffic().kernels;
    const SurfaceView view = gpu.raycast(camera, T_world_camera).value();
    const SurfaceView wanted = raycast(cpu.content(), camera, T_world_camera, {}).value();
    EXPECT_TRUE(std::equal(view.depth.data(), view.depth.data() + view.depth.size(), wanted.depth.data()));
    return gpu.traffic().kernels - before;
  };
  const DepthImage depth = run.depth();
  ASSERT_TRUE(gpu.integrate(camera, depth, T_world_camera).ok());
  ASSERT_TRUE(cpu.integrate(camera, depth, T_world_camera, {}).ok());
  EXPECT_EQ(kernels_of_cast(), 3U);
  EXPECT_EQ(kernels_of_cast(), 1U);
  ASSERT_TRUE(cpu.forget(run.region()).ok());
  ASSERT_TRUE(cpu.integrate(camera, depth, run.pose(), {}).ok());
  ASSERT_TRUE(gpu.follow(cpu.content(), {}).ok());
  EXPECT_EQ(kernels_of_cast(), 3U);
  EXPECT_EQ(kernels_of_cast(), 1U);
}

TEST(GpuMap, TheOrderOfThreadsIsAnother) {
  using internal::cuda::thread_in_order;
  std::uint32_t same{0};
  for (std::uint32_t order = 0; order < 20; ++order) {
    std::vector<bool> taken(128, false);
    for (std::uint32_t next = 0; next < 128; ++next) {
      const std::uint32_t index = thread_in_order(next, 128, order, order % 3);
      ASSERT_LT(index, 128U);
      EXPECT_FALSE(taken[index]);
      taken[index] = true;
      same += index == next ? 1U : 0U;
    }
  }
  EXPECT_LT(same, 128U + 200U);  // all of order 0, and a few
}

TEST(GpuMap, SurfaceViewsEqualThoseOfTheCpuToTheBit) {
  std::size_t seen{0};
  for (std::uint32_t seed = 1; seed <= kGainRuns; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::RandomMap random{seed};
    for (int step = 0; step < 5; ++step) random.step();
    const TsdfSnapshot map = random.snapshot();
    GpuMap gpu = map_in_order(map.config, seed - 1);
    ASSERT_TRUE(gpu.assign(map).ok());
    PinholeCamera camera = random.run().camera();
    for (int i = 0; i < 3; ++i) {
      const Pose T_world_camera = random.run().pose();
      const SurfaceView expected = raycast(map, camera, T_world_camera, {}).value();
      const SurfaceView view = gpu.raycast(camera, T_world_camera).value();
      std::size_t different{0};
      for (std::size_t p = 0; p < view.depth.size(); ++p) {
        different +=
            view.depth.data()[p] != expected.depth.data()[p] || view.normals.data()[p] != expected.normals.data()[p]
                ? 1
                : 0;
        seen += expected.depth.data()[p] > 0.0F ? 1 : 0;
      }
      ASSERT_EQ(different, 0U) << "of " << view.depth.size();
    }
  }
  EXPECT_GT(seen, static_cast<std::size_t>(kGainRuns) * 100);
}

TEST(GpuMap, AnEmptyMapIsUnknownEverywhere) {
  TsdfConfig config;
  config.voxel_size_m = 0.02;
  GpuMap map = GpuMap::create_emulated(config, {}).value();
  EXPECT_TRUE(map.snapshot().value().grid.empty());
  const std::vector<Pose> poses{Pose::Identity()};
  const Region region{Sphere{{0.0, 0.0, 1.0}, 0.2}};
  const GainResult expected = evaluate_views({config, {}}, region, poses, {}, {}).value();
  const GainResult result = map.evaluate_views(region, poses, {}, {}).value();
  EXPECT_EQ(result.gains, expected.gains);
  EXPECT_EQ(result.no_gain, expected.no_gain);
  EXPECT_TRUE(map.evaluate_views(region, {}, {}, {}).ok());
  const PinholeCamera camera{8, 8, 8.0, 8.0, 3.5, 3.5, 0.1, 2.0};
  EXPECT_TRUE(map.integrate(camera, DepthImage{8, 8}, Pose::Identity()).ok());  // no pixel has a return
  EXPECT_TRUE(map.snapshot().value().grid.empty());
}

TEST(GpuMap, SaysWhatItCannotDo) {
  EXPECT_EQ(GpuMap::create_emulated(
                [] {
                  TsdfConfig bad;
                  bad.voxel_size_m = -1.0;
                  return bad;
                }(),
                {})
                .error()
                .code,
            Errc::invalid_argument);
  TsdfConfig config;
  config.voxel_size_m = 0.02;
  GpuMap map = GpuMap::create_emulated(config, {}).value();
  const PinholeCamera camera{8, 8, 8.0, 8.0, 3.5, 3.5, 0.1, 2.0};
  EXPECT_EQ(map.integrate(camera, DepthImage{9, 8}, Pose::Identity()).error().code, Errc::size_mismatch);
  const std::vector<Pose> poses{Pose::Identity()};
  const Region cylinder{Cylinder{{0.0, 0.0, 1.0}, {0.0, 0.0, 1.2}, 0.1}};
  EXPECT_EQ(map.evaluate_views(cylinder, poses, {}, {}).error().code, Errc::unsupported);
  GainConfig distinct;
  distinct.count = GainCount::distinct_voxels;
  const Region sphere{Sphere{{0.0, 0.0, 1.0}, 0.2}};
  EXPECT_EQ(map.evaluate_views(sphere, poses, distinct, {}).error().code, Errc::unsupported);
  std::vector<Pose> bad{Pose::Identity()};
  bad[0].translation().x() = std::nan("");
  EXPECT_EQ(map.evaluate_views(sphere, bad, {}, {}).error().code, Errc::invalid_argument);
  GainConfig huge;  // more tiles of rays than a kernel can have blocks
  huge.sensor = PinholeCamera{16'000, 16'000, 9000.0, 9000.0, 7999.5, 7999.5, 0.1, 2.0};
  std::vector<Pose> many(3000, Pose::Identity());
  for (std::size_t i = 0; i < many.size(); ++i) many[i].translation().x() = 1e-6 * static_cast<double>(i);
  const Region around{Sphere{{0.0, 0.0, 0.0}, 1.0}};
  EXPECT_EQ(map.evaluate_views(around, many, huge, {}).error().code, Errc::unsupported);
  EXPECT_FALSE(map.is_paged()) << "none of this is a lack of memory";
  EXPECT_EQ(map.traffic().kernels, 0U) << "nothing was tried";
  EXPECT_EQ(map.traffic().bytes_sent, 0U);
  EXPECT_EQ(GpuMap::can_evaluate(cylinder, {}).error().code, Errc::unsupported);
  EXPECT_EQ(GpuMap::can_evaluate(sphere, distinct).error().code, Errc::unsupported);
  EXPECT_TRUE(GpuMap::can_evaluate(sphere, {}).ok());
}

TEST(GpuMap, TooLittleMemoryIsAnErrorAndTheCpuGoesOn) {
  test::RandomRun run{3};
  const DepthImage depth = run.depth();
  const Pose T_world_camera = run.pose();
  TsdfMap expected = TsdfMap::create(run.config()).value();
  ASSERT_TRUE(expected.integrate(run.camera(), depth, T_world_camera, {}).ok());
  int failed{0};
  for (std::size_t memory = 1000; failed < 100; memory = memory * 3 / 2) {
    GpuMap map = GpuMap::create_emulated(run.config(), {}, memory).value();
    const auto stats = map.integrate(run.camera(), depth, T_world_camera);
    if (stats.ok()) {
      EXPECT_TRUE(map.snapshot().value().grid == expected.content().grid);
      break;
    }
    EXPECT_EQ(stats.error().code, Errc::unavailable);
    EXPECT_NE(stats.error().message.find("no room"), std::string::npos);
    ++failed;
  }
  EXPECT_GT(failed, 3);
  EXPECT_LT(failed, 100);
}

TEST(GpuMap, TwoMapsLiveSideBySide) {
  test::RandomRun run{5};
  GpuMap a = GpuMap::create_emulated(run.config(), {}).value();
  GpuMap b = GpuMap::create_emulated(run.config(), {}).value();
  const DepthImage depth = run.depth();
  const Pose T_world_camera = run.pose();
  ASSERT_TRUE(a.integrate(run.camera(), depth, T_world_camera).ok());
  EXPECT_TRUE(b.snapshot().value().grid.empty());
  b = std::move(a);
  EXPECT_FALSE(b.snapshot().value().grid.empty());
}

TEST(GpuMap, AMachineWithoutAGpuSaysSo) {
  const auto device = cuda_device();
  const auto map = GpuMap::create({});
  EXPECT_EQ(device.ok(), map.ok());
  if (device.ok()) return;
  EXPECT_EQ(device.error().code, Errc::unavailable);
  EXPECT_FALSE(device.error().message.empty());
}

}  // namespace
}  // namespace saccade
