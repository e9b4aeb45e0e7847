// SPDX-License-Identifier: Apache-2.0
// Tracking on recorded sequences as a faster camera would have taken them, with a blind frame and with a jump.

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "saccade/io/rgbd_folder.hpp"
#include "saccade/map/reconstruction.hpp"
#include "saccade/map/trajectory_error.hpp"
#include "saccade/sensor/gap_filling.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

struct Sequence {
  PinholeCamera camera;
  std::vector<Frame> frames;
};

fs::path folder_of(const char* name) { return fs::path{SACCADE_SHARED_DATA} / name; }

/// Depth images as `saccade fuse` prepares them, all with poses.
Sequence read_sequence(const fs::path& folder, const RgbdFolderConfig& config) {
  Sequence sequence;
  auto source = open_rgbd_folder(folder, config);
  EXPECT_TRUE(source.ok());
  if (!source) return sequence;
  sequence.camera = (*source)->camera();
  std::optional<GapFilling> gaps;
  for (auto next = (*source)->next(); next.ok() && next->has_value(); next = (*source)->next()) {
    Frame frame = std::move(**next);
    EXPECT_TRUE(frame.T_world_camera.has_value()) << frame.name;
    if (!gaps) gaps = choose_gap_filling(frame.depth);
    frame.depth = fill_gaps(frame.depth, *gaps);
    sequence.frames.push_back(std::move(frame));
  }
  return sequence;
}

Result<Reconstruction> reconstruction() {
  ReconstructionConfig config;
  config.map.voxel_size_m = 0.01;
  return Reconstruction::create(config);
}

struct FastCamera {
  const char* folder;
  std::size_t every_nth;
  std::size_t frames;
  double max_aligned_rmse_m;
  double max_m;
};
void PrintTo(const FastCamera& test, std::ostream* out) { *out << test.folder << ", every " << test.every_nth; }

class EveryNthFrame : public testing::TestWithParam<FastCamera> {};

TEST_P(EveryNthFrame, IsTrackedByIcpWithoutALoss) {
  const FastCamera& test = GetParam();
  const fs::path folder = folder_of(test.folder);
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder;
  const auto count = static_cast<std::size_t>(test::scaled_cases(static_cast<int>(test.frames)));
  const Sequence sequence = read_sequence(
      folder, {.read_color = false, .every_nth = test.every_nth, .count = std::max<std::size_t>(4, count)});
  auto r = reconstruction();
  ASSERT_TRUE(r.ok());
  const Executor executor = Executor::with_threads(0);
  std::vector<Pose> tracked;
  std::vector<Pose> given;
  double widest_step_m{0.0};
  for (const Frame& frame : sequence.frames) {
    const auto report = r->process(frame, sequence.camera, TrackingMode::icp, frame.T_world_camera, executor);
    ASSERT_TRUE(report.ok()) << report.error().to_string();
    ASSERT_EQ(report->status, FrameReport::Status::fused) << frame.name << ": " << report->why;
    if (!given.empty()) {
      widest_step_m =
          std::max(widest_step_m, (frame.T_world_camera->translation() - given.back().translation()).norm());
    }
    tracked.push_back(report->T_world_camera);
    given.push_back(*frame.T_world_camera);
  }
  const auto error = trajectory_error(tracked, given);
  ASSERT_TRUE(error.ok());
  EXPECT_LT(error->aligned_rmse_m, test.max_aligned_rmse_m);
  EXPECT_LT(error->max_m, test.max_m);
  std::printf("%zu frames, up to %.1f cm apart: %.1f mm RMSE, %.1f mm at most\n", error->poses, 100.0 * widest_step_m,
              1e3 * error->aligned_rmse_m, 1e3 * error->max_m);
}

INSTANTIATE_TEST_SUITE_P(RecordedTracking, EveryNthFrame,
                         testing::Values(FastCamera{"rgbd_redkitchen", 1, 200, 0.03, 0.05},
                                         FastCamera{"rgbd_redkitchen", 2, 100, 0.03, 0.05},
                                         FastCamera{"rgbd_redkitchen", 3, 67, 0.03, 0.05},
                                         FastCamera{"rgbd_redkitchen", 2, 50, 0.03, 0.05},
                                         FastCamera{"rgbd_redkitchen", 3, 34, 0.03, 0.05},
                                         FastCamera{"rgbd_realsense_box", 2, 13, 0.004, 0.008},
                                         FastCamera{"rgbd_realsense_box", 3, 9, 0.004, 0.008}));

}  // namespace
}  // namespace saccade
