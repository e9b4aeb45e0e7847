// SPDX-License-Identifier: Apache-2.0
// A device that fails in the middle of its work: every call says so, and nothing else breaks.
#include <gtest/gtest.h>

#include <string>

#include "saccade/cuda/internal/gpu_fusion.hpp"
#include "saccade/cuda/internal/gpu_gain.hpp"
#include "saccade/cuda/internal/gpu_raycast.hpp"
#include "support/lost_compute.hpp"
#include "support/random_run.hpp"

namespace saccade::internal::cuda {
namespace {

TEST(LostDevice, EveryCallSaysSo) {
  test::RandomRun run{4};
  PinholeCamera camera = run.camera();
  camera.max_range_m = 0.5 * run.extent();
  const DepthImage depth{camera.width, camera.height, static_cast<float>(0.4 * run.extent())};
  const Pose T_world_camera = run.pose();
  const std::vector<Pose> poses{T_world_camera, run.pose()};
  const Region region{Sphere{Eigen::Vector3d::Zero(), 0.4 * run.extent()}};
  GainConfig config;
  config.sensor = camera;
  const GainTask task = prepare_gains(run.config(), region, poses, config, {}).value();
  int ended{0};
  for (int operations = 0; operations < 200 && ended == 0; ++operations) {
    SCOPED_TRACE(operations);
    test::LostCompute device{operations};
    BrickStore bricks{device};
    GpuFusion fusion{device};
    GpuGain gain{device};
    GpuRaycast raycast{device};
    const auto stats = fusion.integrate(run.config(), camera, depth, T_world_camera, bricks);
    const auto gains = gain.count(task, bricks);
    const auto view = raycast.cast(run.config(), camera, T_world_camera, bricks);
    const auto content = bricks.snapshot(run.config());
    if (stats.ok() && gains.ok() && view.ok() && content.ok()) ++ended;
    EXPECT_TRUE(ended == 0 || operations > 20);
    EXPECT_TRUE(stats.ok() || stats.error().message == "the device is lost");
    EXPECT_TRUE(gains.ok() || gains.error().code == Errc::unavailable);
    EXPECT_TRUE(view.ok() || view.error().code == Errc::unavailable);
  }
  EXPECT_EQ(ended, 1);
}

TEST(LostDevice, SpaceBeyondATableIsAnErrorBeforeAnyMemoryIsTaken) {
  HostCompute device{Executor{}, 4000};
  BrickStore bricks{device};
  const Status covered = bricks.cover({{0, 0, 0}, {1000, 1000, 1000}});
  ASSERT_FALSE(covered.ok());
  EXPECT_EQ(covered.error().code, Errc::unsupported);
  EXPECT_TRUE(bricks.cover({{0, 0, 0}, {0, 0, 0}}).ok());
  EXPECT_TRUE(bricks.cover({{-3, -2, -1}, {1, 1, 1}}).ok());
  EXPECT_EQ(bricks.view().bricks.lo, (Index3{-4, -4, -4}));
}

/// A growth that fails leaves the table that was there, with its blocks.
TEST(LostDevice, AFailedGrowthLeavesTheTable) {
  int failed{0};
  for (std::size_t memory = 4000; memory < 400'000; memory += memory / 8) {
    HostCompute device{Executor{}, memory};
    BrickStore bricks{device};
    ASSERT_TRUE(bricks.cover({{0, 0, 0}, {1, 1, 1}}).ok());
    const MapView before = bricks.view();
    if (bricks.cover({{0, 0, 0}, {32, 32, 32}}).ok()) continue;
    ++failed;
    const MapView after = bricks.view();
    EXPECT_EQ(after.bricks.count(), before.bricks.count());
    EXPECT_EQ(after.blocks.count(), before.blocks.count());
    EXPECT_TRUE(bricks.mark_blocks().ok());
  }
  EXPECT_GT(failed, 3);
}

}  // namespace
}  // namespace saccade::internal::cuda
