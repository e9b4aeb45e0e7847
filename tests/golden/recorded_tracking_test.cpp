// SPDX-License-Identifier: Apache-2.0
// Tracking on recorded sequences as a faster camera would have taken them, with a blind frame and with a jump.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "saccade/io/frames/rgbd_folder.hpp"
#include "saccade/sensor/gap_filling.hpp"
#include "saccade/tracking/reconstruction.hpp"
#include "saccade/tracking/trajectory_error.hpp"
#include "support/effort.hpp"
#include "support/places.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

struct Sequence {
  PinholeCamera camera;
  std::vector<Frame> frames;
};

fs::path folder_of(const char* name) { return test::shared_data() / name; }

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

Result<Reconstruction> centimetre_reconstruction() {
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
  const auto count = static_cast<std::size_t>(std::max(4, test::scaled_cases(static_cast<int>(test.frames))));
  const Sequence sequence = read_sequence(folder, {.read_color = false, .every_nth = test.every_nth, .count = count});
  ASSERT_EQ(sequence.frames.size(), count);
  auto r = centimetre_reconstruction();
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

// Measured: 13.3 mm RMSE and 27.4 mm at most in the kitchen with every second of 120 frames, 13.1 and 27.7 mm with
// every third; 2.2 and 3.7 mm, 1.9 and 3.1 mm around the box.
INSTANTIATE_TEST_SUITE_P(RecordedTracking, EveryNthFrame,
                         testing::Values(FastCamera{"rgbd_redkitchen", 2, 60, 0.020, 0.040},
                                         FastCamera{"rgbd_redkitchen", 3, 40, 0.020, 0.040},
                                         FastCamera{"rgbd_realsense_box", 2, 13, 0.0035, 0.006},
                                         FastCamera{"rgbd_realsense_box", 3, 9, 0.0035, 0.006}));

/// A few frames fused, the last of them known: every second one, up to where the camera has moved on.
class LostOnRecordedData : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const fs::path folder = folder_of(GetParam());
    if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder;
    sequence_ = read_sequence(folder, {.read_color = false, .every_nth = 2, .count = kFused + 3});
    ASSERT_EQ(sequence_.frames.size(), kFused + 3);
    auto made = centimetre_reconstruction();
    ASSERT_TRUE(made.ok());
    r_.emplace(std::move(made).value());
    for (std::size_t i = 0; i < kFused; ++i) fuse(i);
  }

  FrameReport process(const Frame& frame, TrackingMode mode, const std::optional<Pose>& hint) {
    const auto report = r_->process(frame, sequence_.camera, mode, hint, executor_);
    EXPECT_TRUE(report.ok());
    return report.ok() ? *report : FrameReport{};
  }
  void fuse(std::size_t i) {
    const Frame& frame = sequence_.frames[i];
    const FrameReport report = process(frame, TrackingMode::icp, frame.T_world_camera);
    ASSERT_EQ(report.status, FrameReport::Status::fused) << frame.name << ": " << report.why;
    EXPECT_LT((report.T_world_camera.translation() - frame.T_world_camera->translation()).norm(), 0.02) << frame.name;
  }
  void expect_lost(const Frame& frame, TrackingMode mode, const std::optional<Pose>& hint, const std::string& what) {
    const TsdfSnapshot before = r_->map().snapshot();
    const Pose last = *r_->last_pose();
    const FrameReport report = process(frame, mode, hint);
    EXPECT_EQ(report.status, FrameReport::Status::lost) << what << ": " << report.icp.agreement;
    EXPECT_FALSE(report.why.empty());
    EXPECT_TRUE(before.grid == r_->map().content().grid) << what;
    EXPECT_TRUE(last.matrix() == r_->last_pose()->matrix());
  }

  static constexpr std::size_t kFused{4};
  Sequence sequence_;
  Executor executor_{Executor::with_threads(0)};
  std::optional<Reconstruction> r_;
};

TEST_P(LostOnRecordedData, ABlindFrameIsNotFusedAndTheNextOneIs) {
  Frame zeros = sequence_.frames[kFused];
  zeros.depth = DepthImage{sequence_.camera.width, sequence_.camera.height};
  expect_lost(zeros, TrackingMode::icp, std::nullopt, "zeros");
  fuse(kFused + 1);
  fuse(kFused + 2);
}

/// Wherever ICP starts 30 cm beside the camera, it must not take a place where only some planes fit. (Without
/// IcpConfig::min_agreement one start in six was fused in the kitchen, 12 to 37 cm off.)
TEST_P(LostOnRecordedData, AJumpOf30CmIsNotFusedAndAHintRecovers) {
  constexpr int kStarts{test::scaled_cases(26)};
  const Frame& next = sequence_.frames[kFused];
  int tried{0};
  for (int i = 0; i < 27; ++i) {
    const int row = i / 3;
    const int layer = i / 9;
    const Eigen::Vector3d direction{i % 3 - 1.0, row % 3 - 1.0, layer - 1.0};
    if (direction.isZero() || tried == kStarts) continue;
    Pose wrong = *next.T_world_camera;
    wrong.translation() += 0.30 * direction.normalized();
    expect_lost(next, TrackingMode::hint, wrong, "start " + std::to_string(i));
    ++tried;
  }
  EXPECT_EQ(tried, kStarts);

  Pose hint = *next.T_world_camera;
  hint.translation() += Eigen::Vector3d{0.02, -0.02, 0.02};
  const FrameReport recovered = process(next, TrackingMode::hint, hint);
  ASSERT_EQ(recovered.status, FrameReport::Status::fused) << recovered.why;
  EXPECT_LT((recovered.T_world_camera.translation() - next.T_world_camera->translation()).norm(), 0.02);
  fuse(kFused + 1);
}

INSTANTIATE_TEST_SUITE_P(RecordedTracking, LostOnRecordedData,
                         testing::Values("rgbd_redkitchen", "rgbd_realsense_box"));

/// The camera moves on unseen, by 13 cm and by more than 31 cm: lost until a hint says where it is. Held to tracking
/// without a gap, which ends within 1.0 cm of the recovered pose; both are 8 cm from the given one, which drifts.
TEST(RecordedTracking, SkippedFramesAreNotFusedAndAHintRecovers) {
  const fs::path folder = folder_of("rgbd_redkitchen");
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder;
  constexpr std::size_t kFused{4};
  const Sequence sequence = read_sequence(folder, {.read_color = false, .first = 60, .every_nth = 3, .count = 23});
  ASSERT_EQ(sequence.frames.size(), 23U);
  const Executor executor = Executor::with_threads(0);
  auto r = centimetre_reconstruction();
  auto without_gap = centimetre_reconstruction();
  ASSERT_TRUE(r.ok() && without_gap.ok());
  const auto process = [&](Reconstruction& with, std::size_t i, TrackingMode mode) {
    const Frame& frame = sequence.frames[i];
    const auto report = with.process(frame, sequence.camera, mode, frame.T_world_camera, executor);
    EXPECT_TRUE(report.ok()) << frame.name;
    return report.ok() ? *report : FrameReport{};
  };
  std::vector<Pose> truth;
  for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
    const FrameReport report = process(*without_gap, i, TrackingMode::icp);
    ASSERT_EQ(report.status, FrameReport::Status::fused) << i << ": " << report.why;
    truth.push_back(report.T_world_camera);
    if (i < kFused) {
      ASSERT_EQ(process(*r, i, TrackingMode::icp).status, FrameReport::Status::fused);
    }
  }
  const TsdfSnapshot before = r->map().snapshot();
  for (const std::size_t i : {10U, 20U, 21U}) {
    const FrameReport report = process(*r, i, TrackingMode::icp);
    EXPECT_EQ(report.status, FrameReport::Status::lost) << i;
    EXPECT_GT((truth[i].translation() - truth[kFused - 1].translation()).norm(), i == 10 ? 0.10 : 0.29);
  }
  EXPECT_TRUE(before.grid == r->map().content().grid);
  for (const std::size_t i : {21U, 22U}) {
    const FrameReport report = process(*r, i, i == 21 ? TrackingMode::hint : TrackingMode::icp);
    ASSERT_EQ(report.status, FrameReport::Status::fused) << i << ": " << report.why;
    EXPECT_LT((report.T_world_camera.translation() - truth[i].translation()).norm(), 0.02) << i;
  }
}

}  // namespace
}  // namespace saccade
