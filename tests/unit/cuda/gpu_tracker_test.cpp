// SPDX-License-Identifier: Apache-2.0
// A reconstruction whose frames a device tracks has the poses and the map of one on the CPU, to the bit: also where the
// device has no room, or is lost in the middle.
#include "saccade/cuda/gpu_tracker.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "failing_compute.hpp"
#include "saccade/cuda/internal/gpu_map_impl.hpp"
#include "saccade/tracking/reconstruction.hpp"
#include "support/parallel_backend.hpp"
#include "things_on_a_table.hpp"

namespace saccade {
namespace {

const PinholeCamera kSmallImage{128, 96, 110.0, 110.0, 63.5, 47.5, 0.4, 2.5};

struct Tracked {
  std::vector<Pose> T_world_camera;
  TsdfSnapshot map;
  int tracked{0};
};

/// Fuses frames of a camera that moves around the table. @param device nullptr: the CPU tracks.
/// @param before  called before each frame, with its number
Tracked tracked(TrackingMode mode, TrackingDevice* device, const std::function<void(int)>& before = {}) {
  const Executor executor = Executor::with_threads(2, test::kParallelBackend);
  ReconstructionConfig config;
  config.map.voxel_size_m = 0.012;
  Reconstruction reconstruction = Reconstruction::create(config).value();
  reconstruction.track_on(device);
  Tracked result;
  for (int i = 0; i < 5; ++i) {
    if (before) before(i);
    const double turn = 0.02 * i * std::numbers::pi;
    const Pose T_world_true =
        look_at({0.6 * std::cos(turn), 0.6 * std::sin(turn), 0.5}, {0.0, 0.0, 0.05}, Eigen::Vector3d::UnitZ());
    RenderedFrame seen = render(test::things_on_a_table(), kSmallImage, T_world_true, executor).value();
    Frame frame;
    frame.depth = std::move(seen.depth);
    const FrameReport report = reconstruction.process(frame, kSmallImage, mode, T_world_true, executor).value();
    result.T_world_camera.push_back(report.T_world_camera);
    result.tracked += report.track_ms > 0.0 && report.status == FrameReport::Status::fused ? 1 : 0;
  }
  result.map = reconstruction.map().snapshot();
  return result;
}

void expect_same(const Tracked& result, const Tracked& expected) {
  for (std::size_t i = 0; i < expected.T_world_camera.size(); ++i) {
    EXPECT_EQ(result.T_world_camera[i].matrix(), expected.T_world_camera[i].matrix()) << i;
  }
  EXPECT_TRUE(result.map.grid == expected.map.grid);
}

TEST(GpuTracker, TracksToTheBit) {
  for (const TrackingMode mode : {TrackingMode::icp, TrackingMode::hint, TrackingMode::rgbd}) {
    SCOPED_TRACE(to_string(mode));
    const Tracked expected = tracked(mode, nullptr);
    EXPECT_EQ(expected.tracked, 4);
    GpuTracker gpu =
        GpuTracker::create_emulated(expected.map.config, Executor::with_threads(2, test::kParallelBackend)).value();
    expect_same(tracked(mode, &gpu), expected);
    EXPECT_GE(gpu.answered(), mode == TrackingMode::rgbd ? 4U : 8U);
    EXPECT_FALSE(gpu.take_problem());
  }
}

TEST(GpuTracker, ADeviceLostInTheMiddleIsToldOnce) {
  const Tracked expected = tracked(TrackingMode::icp, nullptr);
  const auto faults = std::make_shared<test::Faults>();
  faults->times = 0;
  GpuTracker gpu{internal::cuda::GpuMapMaker::make(expected.map.config, std::make_unique<test::FailingCompute>(faults)),
                 GpuAligner::create_emulated({}).value()};
  std::vector<int> told;
  const auto before = [&](int frame) {
    faults->lost = frame >= 3;
    if (gpu.take_problem()) told.push_back(frame);
  };
  expect_same(tracked(TrackingMode::icp, &gpu, before), expected);
  EXPECT_EQ(gpu.answered(), 4U) << "two frames";
  EXPECT_EQ(told, std::vector{4});
  EXPECT_FALSE(gpu.take_problem());
}

TEST(GpuTracker, WithoutRoomTheCpuTracks) {
  const Tracked expected = tracked(TrackingMode::icp, nullptr);
  GpuTracker gpu = GpuTracker::create_emulated(expected.map.config, {}, 1000).value();
  expect_same(tracked(TrackingMode::icp, &gpu), expected);
  const auto problem = gpu.take_problem();
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->code, Errc::unavailable);
  EXPECT_FALSE(gpu.take_problem()) << "once";
}

}  // namespace
}  // namespace saccade
