// SPDX-License-Identifier: Apache-2.0
// saccade-folder-camera: a recorded folder as a camera.
#include "device_programs.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/rgbd_folder.hpp"

namespace saccade::test {
namespace {

constexpr int kFrames{4};

/// Where frame i of the folder was taken: 30 cm apart; the last one beside the first, but looking up.
Pose taken_at(int i) {
  if (i == kFrames - 1) return look_at({0.1, 0.0, 0.5}, {0.1, 0.0, 2.0});
  return look_at({0.3 * i, 0.0, 0.5}, {0.3 * i, 0.0, 0.0});
}

class FolderCameraProgram : public ::testing::Test {
 protected:
  FolderCameraProgram() {
    folder_.write("camera-intrinsics.txt", "10 0 3.5\n0 11 2.5\n0 0 1\n");
    for (int i = 0; i < kFrames; ++i) {
      const std::string stem = "frame-00000" + std::to_string(i);
      Image16 depth{8, 6, static_cast<std::uint16_t>(1000 + 100 * i)};
      depth(2, 1) = static_cast<std::uint16_t>(700 + i);
      depth(3, 1) = 0;
      ColorImage color{8, 6, Rgb8{1, 2, 3}};
      color(4, 5) = {200, 100, static_cast<std::uint8_t>(i)};
      EXPECT_TRUE(write_png16(folder_ / (stem + ".depth.png"), depth));
      EXPECT_TRUE(write_png(folder_ / (stem + ".color.png"), color));
      std::ostringstream pose;
      pose.precision(12);
      pose << taken_at(i).matrix();
      folder_.write(stem + ".pose.txt", pose.str());
    }
  }
  [[nodiscard]] std::string command(const std::string& options = "") const {
    return device_command("folder-camera", "", quoted(folder_.path()) + " " + options);
  }

  TempFolder folder_;
};

void expect_frame(const Result<Frame>& frame, int i) {
  ASSERT_TRUE(frame.ok()) << frame.error().to_string();
  EXPECT_TRUE(frame->T_world_camera->isApprox(taken_at(i), 1e-9)) << i;
  EXPECT_NEAR(frame->depth(0, 0), 1.0F + 0.1F * static_cast<float>(i), 1e-6F);
  EXPECT_NEAR(frame->depth(2, 1), 0.7F + 0.001F * static_cast<float>(i), 1e-6F);
  EXPECT_EQ(frame->depth(3, 1), 0.0F);
  ASSERT_TRUE(frame->color.has_value());
  EXPECT_EQ((*frame->color)(4, 5), (Rgb8{200, 100, static_cast<std::uint8_t>(i)}));
  EXPECT_EQ((*frame->color)(5, 5), (Rgb8{1, 2, 3}));
}

TEST_F(FolderCameraProgram, AnswersWithTheNearestFrameAndItsPose) {
  auto camera = started(command("--max-range 3 --layout seven-scenes"));
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->intrinsics(), (PinholeCamera{8, 6, 10, 11, 3.5, 2.5, 0.2, 3.0}));
  for (const int i : {2, 0, 1}) {
    Pose near = taken_at(i);
    near.translation() += Eigen::Vector3d{0.1, 0.08, -0.05};
    expect_frame(camera->capture(near), i);
  }
  // Between the first and the last one, where the camera looks decides.
  expect_frame(camera->capture(look_at({0.1, 0.0, 0.5}, {0.1, 0.0, 0.0})), 0);
  Pose upwards = taken_at(3);
  upwards.translation().x() = 0.0;
  expect_frame(camera->capture(upwards), 3);
}

TEST_F(FolderCameraProgram, SaysHowFarTheNearestFrameIs) {
  auto camera = started(command());
  ASSERT_TRUE(camera);
  const auto far = camera->capture(look_at({0.6, 0.0, 1.25}, {0.6, 0.0, 0.0}));
  ASSERT_FALSE(far.ok());
  for (const char* words : {"the nearest frame, number 2, was taken 0.75 m from the pose", "4 frames",
                            "x 0.00 to 0.60, y 0.00 to 0.00, z 0.50 to 0.50 m"}) {
    EXPECT_NE(far.error().message.find(words), std::string::npos) << far.error().to_string();
  }
  expect_frame(camera->capture(taken_at(1)), 1);  // and goes on
}

TEST_F(FolderCameraProgram, PlaysFramesInOrder) {
  auto camera = started(command("--in-order"));
  ASSERT_TRUE(camera);
  for (int i = 0; i < kFrames; ++i) expect_frame(camera->capture(taken_at(1)), i);
  const auto after = camera->capture(taken_at(1));
  ASSERT_FALSE(after.ok());
  EXPECT_NE(after.error().message.find("all 4 frames"), std::string::npos) << after.error().to_string();
}

TEST_F(FolderCameraProgram, SaysWhatItCannotOpen) {
  EXPECT_NE(refusal(device_command("folder-camera", "", "/nowhere")).find("/nowhere"), std::string::npos);
  EXPECT_NE(refusal(device_command("folder-camera", "", "")).find("which folder?"), std::string::npos);
  EXPECT_NE(refusal(command("--inorder 1")).find("unknown option --inorder"), std::string::npos);
  EXPECT_NE(refusal(command("--layout film")).find("seven_scenes"), std::string::npos);
  for (int i = 0; i < kFrames; ++i) fs::remove(folder_ / ("frame-00000" + std::to_string(i) + ".pose.txt"));
  EXPECT_NE(refusal(command()).find("has a pose"), std::string::npos) << refusal(command());
  auto camera = started(command("--in-order"));  // without poses it is believed to be where it is asked to be
  ASSERT_TRUE(camera);
  const auto frame = camera->capture(Pose::Identity());
  ASSERT_TRUE(frame.ok()) << frame.error().to_string();
  EXPECT_TRUE(frame->T_world_camera->isApprox(Pose::Identity()));
}

TEST(FolderCameraRecorded, PlaysRecordingsOfEveryLayout) {
  int played = 0;
  for (const char* name : {"rgbd_redkitchen", "rgbd_open3d5/RGBD", "rgbd_eyeinhand_shelfA", "rgbd_realsense_box"}) {
    const fs::path recording = shared_data() / name;
    if (!fs::exists(recording)) continue;
    const auto source = open_rgbd_folder(recording);
    ASSERT_TRUE(source.ok()) << source.error().to_string();
    const auto truth = (*source)->at(*(*source)->size() - 1);
    ASSERT_TRUE(truth.ok()) << truth.error().to_string();
    auto camera = started(device_command("folder-camera", "", quoted(recording)));
    ASSERT_TRUE(camera);
    const auto frame = camera->capture(*truth->T_world_camera);
    ASSERT_TRUE(frame.ok()) << frame.error().to_string();
    EXPECT_EQ(frame->depth, truth->depth) << name;
    EXPECT_EQ(frame->color, truth->color) << name;
    ++played;
  }
  if (played == 0) GTEST_SKIP() << "no recordings in " << shared_data();
}

}  // namespace
}  // namespace saccade::test
