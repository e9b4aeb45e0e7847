// SPDX-License-Identifier: Apache-2.0
// Steps of an exploration on the kernels of the GPU, run on the host: with all the memory it wants, with little, and on
// a device that is lost in the middle. Every result equals the CPU's to the bit.
#include "saccade/cuda/hybrid_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "saccade/cuda/internal/gpu_map_impl.hpp"
#include "saccade/views/internal/state_volume.hpp"
#include "support/effort.hpp"
#include "support/lost_compute.hpp"
#include "support/random_run.hpp"

namespace saccade {
namespace {

using internal::cuda::GpuMapMaker;

constexpr int kSteps{3};

/// Input of a step: an image, where it was taken, and views to evaluate.
struct StepInput {
  DepthImage depth;
  Pose T_world_camera;
  std::vector<Pose> views;
  Region region;
};

/// A short exploration and its results on the CPU.
class Exploration {
 public:
  explicit Exploration(std::uint32_t seed) : run_{test::RandomRun::with_clearing(seed)} {
    camera_ = run_.camera();
    camera_.max_range_m = std::min(camera_.max_range_m, 1.5 * run_.extent());
    gain_.sensor = camera_;
    surface_.reach_m = 6.0 * config().voxel_size_m;
    surface_.min_support_m2 = 400.0 * config().voxel_size_m * config().voxel_size_m;
    TsdfMap map = TsdfMap::create(config()).value();
    for (int i = 0; i < kSteps; ++i) {
      StepInput& step = steps_.emplace_back(StepInput{run_.depth(), run_.pose(), {}, run_.region()});
      for (int k = 0; k < 3; ++k) step.views.push_back(run_.pose());
      if (i > 0 && std::holds_alternative<Cylinder>(step.region))
        step.region = Sphere{{0.0, 0.0, 0.0}, 0.3 * run_.extent()};
      EXPECT_TRUE(map.integrate(camera_, step.depth, step.T_world_camera, {}).ok());
      wanted_.push_back({map.snapshot(), raycast(map.content(), camera_, step.T_world_camera, {}).value(),
                         evaluate_views(map.content(), step.region, step.views, gain_, {}).value(),
                         expected_surface(map.content(), surface_, {}).value()});
    }
  }
  [[nodiscard]] const TsdfConfig& config() const { return run_.config(); }

  /// Runs it on a device and compares every result. @param surface whether each step asks for the expected surface.
  void expect_equal_on(HybridMap& map, bool surface) const {
    for (int i = 0; i < kSteps; ++i) {
      SCOPED_TRACE("step " + std::to_string(i));
      const StepInput& step = steps_[static_cast<std::size_t>(i)];
      const Wanted& wanted = wanted_[static_cast<std::size_t>(i)];
      const auto stats = map.integrate(camera_, step.depth, step.T_world_camera, {});
      ASSERT_TRUE(stats.ok()) << stats.error().to_string();
      const auto seen = map.raycast(camera_, step.T_world_camera, {});
      ASSERT_TRUE(seen.ok()) << seen.error().to_string();
      EXPECT_EQ(std::memcmp(seen->depth.data(), wanted.seen.depth.data(), seen->depth.size() * sizeof(float)), 0);
      const auto gains = map.evaluate_views(step.region, step.views, gain_, {});
      ASSERT_TRUE(gains.ok()) << gains.error().to_string();
      EXPECT_EQ(gains->gains, wanted.gains.gains);
      EXPECT_EQ(gains->no_gain, wanted.gains.no_gain);
      if (surface) expect_equal(map.expected_surface(surface_, {}).value(), wanted.surface);
    }
    EXPECT_TRUE(map.snapshot({}).value().grid == wanted_.back().map.grid);
  }

 private:
  struct Wanted {
    TsdfSnapshot map;
    SurfaceView seen;
    GainResult gains;
    ExpectedSurface surface;
  };
  static void expect_equal(const ExpectedSurface& got, const ExpectedSurface& wanted) {
    ASSERT_EQ(got.points.size(), wanted.points.size());
    for (std::size_t i = 0; i < got.points.size(); ++i) {
      EXPECT_EQ(got.points[i].voxel, wanted.points[i].voxel);
      EXPECT_EQ(got.points[i].area_cm2, wanted.points[i].area_cm2);
    }
    EXPECT_EQ(got.seen_cm2, wanted.seen_cm2);
  }

  test::RandomRun run_;
  PinholeCamera camera_;
  GainConfig gain_;
  ExpectedSurfaceConfig surface_;
  std::vector<StepInput> steps_;
  std::vector<Wanted> wanted_;
};

TEST(HybridMap, StepsOnTheGpuAndOnTheCpuAreEqual) {
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Exploration exploration{seed};
    HybridMap on_gpu =
        HybridMap::create(exploration.config(), GpuMap::create_emulated(exploration.config(), {}).value()).value();
    exploration.expect_equal_on(on_gpu, seed % 2 == 0);
    EXPECT_TRUE(on_gpu.on_gpu());
    HybridMap on_cpu = HybridMap::create(exploration.config(), std::nullopt).value();
    exploration.expect_equal_on(on_cpu, true);
    EXPECT_FALSE(on_cpu.on_gpu());
  }
}

TEST(HybridMap, ShortMemoryIsPagedOrLeftToTheCpu) {
  int paged{0};
  int whole{0};
  int by_cpu{0};
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const Exploration exploration{seed};
    for (std::size_t memory = 100'000; memory < 400'000'000; memory = memory * 3 / 2) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", memory " + std::to_string(memory));
      HybridMap map =
          HybridMap::create(exploration.config(), GpuMap::create_emulated(exploration.config(), {}, memory).value())
              .value();
      exploration.expect_equal_on(map, false);
      ASSERT_TRUE(map.on_gpu()) << "no memory is an error of a step, not the loss of the device";
      by_cpu += map.gpu_problem().empty() ? 0 : 1;
      const bool had_enough = !map.gpu()->is_paged();
      (had_enough ? whole : paged) += 1;
      if (had_enough) break;
    }
  }
  EXPECT_EQ(whole, 3);
  EXPECT_GT(paged, 6);
  EXPECT_GT(by_cpu, 3);
}

/// Three places far apart are looked at in turn, on a device with room for one of them.
TEST(HybridMap, PagesComeAndGoAsTheWorkMoves) {
  TsdfConfig config;
  config.voxel_size_m = 0.003;
  const PinholeCamera camera{64, 48, 60.0, 60.0, 31.5, 23.5, 0.2, 1.0};
  DepthImage depth{camera.width, camera.height};
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) depth(u, v) = 0.5F + 0.1F * std::sin(0.3F * static_cast<float>(u + v));
  }
  std::vector<Pose> poses;
  for (const double x : {0.0, 6.0, 12.0, 0.0}) {
    poses.push_back(Pose::Identity());
    poses.back().translation() = Eigen::Vector3d{x, 0.003 * static_cast<double>(poses.size()), 0.0};
  }
  int done_in_pages{0};
  int followed{0};
  for (std::size_t memory = 4'000'000; memory < 100'000'000; memory *= 2) {
    SCOPED_TRACE(memory);
    TsdfMap expected = TsdfMap::create(config).value();
    HybridMap map = HybridMap::create(config, GpuMap::create_emulated(config, {}, memory).value()).value();
    for (const Pose& pose : poses) {
      ASSERT_TRUE(expected.integrate(camera, depth, pose, {}).ok());
      ASSERT_TRUE(map.integrate(camera, depth, pose, {}).ok());
      const SurfaceView wanted = raycast(expected.content(), camera, pose, {}).value();
      const SurfaceView seen = map.raycast(camera, pose, {}).value();
      EXPECT_EQ(std::memcmp(seen.depth.data(), wanted.depth.data(), seen.depth.size() * sizeof(float)), 0);
      GainConfig gain;
      gain.sensor = camera;
      const Region region{Sphere{pose.translation() + Eigen::Vector3d{0.0, 0.0, 0.6}, 0.15}};
      const std::vector<Pose> views{pose};
      EXPECT_EQ(map.evaluate_views(region, views, gain, {}).value().gains,
                evaluate_views(expected.content(), region, views, gain, {}).value().gains);
    }
    EXPECT_TRUE(map.snapshot({}).value().grid == expected.content().grid);
    ASSERT_TRUE(map.on_gpu());
    done_in_pages += map.gpu()->is_paged() && map.gpu_problem().empty() ? 1 : 0;
    // The host goes on with its own map, and the device follows.
    GpuMap& gpu = *map.gpu();
    for (const Pose& pose : poses) {
      ASSERT_TRUE(gpu.raycast(camera, pose).ok() || gpu.is_paged());
      ASSERT_TRUE(expected.forget(Sphere{pose.translation() + Eigen::Vector3d{0.05, 0.0, 0.5}, 0.08}).ok());
      ASSERT_TRUE(gpu.follow(expected.content(), {}).ok());
      const std::uint64_t sent = gpu.traffic().bytes_sent;
      ASSERT_TRUE(gpu.follow(expected.content(), {}).ok());
      EXPECT_EQ(gpu.traffic().bytes_sent, sent);
      const SurfaceView wanted = raycast(expected.content(), camera, pose, {}).value();
      const auto seen = gpu.raycast(camera, pose);
      if (!seen.ok()) continue;
      EXPECT_EQ(std::memcmp(seen->depth.data(), wanted.depth.data(), wanted.depth.size() * sizeof(float)), 0);
      ++followed;
    }
    if (!map.gpu()->is_paged()) break;
  }
  EXPECT_GT(done_in_pages, 0);
  EXPECT_GT(followed, 4);
}

TEST(HybridMap, ADeviceLostInTheMiddleLosesNothing) {
  const Exploration exploration{4};
  int lost{0};
  bool ended{false};
  for (int operations = 0; !ended && operations < 2000; operations += operations < 40 ? 1 : 7) {
    SCOPED_TRACE("after " + std::to_string(operations) + " operations");
    HybridMap map =
        HybridMap::create(exploration.config(),
                          GpuMapMaker::make(exploration.config(), std::make_unique<test::LostCompute>(operations)))
            .value();
    exploration.expect_equal_on(map, operations % 3 == 0);
    lost += map.gpu_problem().empty() ? 0 : 1;
    ended = map.gpu_problem().empty();
  }
  EXPECT_TRUE(ended);
  EXPECT_GT(lost, 40);
}

/// A GPU that is lost after many frames: those since the last snapshot alone are fused again.
TEST(HybridMap, ManyFramesAreTakenHomeInTime) {
  TsdfConfig config;
  config.voxel_size_m = 0.02;
  const PinholeCamera camera{16, 12, 16.0, 16.0, 7.5, 5.5, 0.2, 1.0};
  const DepthImage depth{camera.width, camera.height, 0.6F};
  int lost{0};
  constexpr std::size_t kTaken{HybridMap::kMostFrames + 3};
  for (const int operations : {100'000, 340, 315, 300, 270, 200}) {
    SCOPED_TRACE(operations);
    HybridMap map =
        HybridMap::create(config, GpuMapMaker::make(config, std::make_unique<test::LostCompute>(operations))).value();
    TsdfMap expected = TsdfMap::create(config).value();
    for (std::size_t i = 0; i < kTaken; ++i) {
      Pose pose = Pose::Identity();
      pose.translation().x() = 0.01 * static_cast<double>(i);
      ASSERT_TRUE(expected.integrate(camera, depth, pose, {}).ok());
      ASSERT_TRUE(map.integrate(camera, depth, pose, {}).ok());
    }
    EXPECT_TRUE(map.snapshot({}).value().grid == expected.content().grid);
    lost += map.on_gpu() ? 0 : 1;
  }
  EXPECT_GT(lost, 2);
  EXPECT_LT(lost, 6);
}

/// After the frames are on their way, nothing of the map's size goes in or out.
TEST(HybridMap, AStepCopiesNoMap) {
  const Exploration exploration{2};
  GpuMap gpu = GpuMap::create_emulated(exploration.config(), {}).value();
  test::RandomRun run = test::RandomRun::with_clearing(2);
  const PinholeCamera camera = run.camera();
  const DepthImage depth = run.depth();
  const Pose T_world_camera = run.pose();
  ASSERT_TRUE(gpu.integrate(camera, depth, T_world_camera).ok());
  const GpuTraffic before = gpu.traffic();
  ASSERT_TRUE(gpu.integrate(camera, depth, T_world_camera).ok());
  const GpuTraffic fused = gpu.traffic();
  EXPECT_LE(fused.bytes_sent - before.bytes_sent, depth.size() * sizeof(float) + 100);
  EXPECT_LE(fused.bytes_read - before.bytes_read, 200U);
  ASSERT_TRUE(gpu.raycast(camera, T_world_camera).ok());
  const GpuTraffic cast = gpu.traffic();
  EXPECT_LE(cast.bytes_read - fused.bytes_read, depth.size() * 16 + 100);
  const std::size_t known = gpu.snapshot().value().grid.usage().bricks();
  const GpuTraffic pulled = gpu.traffic();
  EXPECT_GT(known, 100U);
  ASSERT_TRUE(gpu.snapshot().ok());
  EXPECT_EQ(gpu.traffic().bytes_read, pulled.bytes_read) << "nothing changed since";
}

}  // namespace
}  // namespace saccade
