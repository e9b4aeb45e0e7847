// SPDX-License-Identifier: Apache-2.0
// saccade-openni2-camera, without a camera: OpenNI2 with a driver of this test, whose picture is known, and recordings
// that OpenNI2 makes of it.
#include <cmath>
#include <cstdlib>
#include <thread>

#include "device_programs.hpp"

namespace saccade::test {
namespace {

/// A copy of OpenNI2, which looks for drivers beside itself: those that are given, and the player of recordings.
class OpenNi2 {
 public:
  explicit OpenNi2(bool with_camera) {
    const fs::path library{SACCADE_OPENNI2_LIBRARY};
    const fs::path drivers = folder_ / "OpenNI2/Drivers";
    fs::create_directories(drivers);
    for (const char* end : {"", ".0"}) {  // Debian's has a number
      fs::copy_file(fs::canonical(library), folder_ / ("libOpenNI2.so" + std::string{end}));
      fs::create_symlink(library.parent_path() / "OpenNI2/Drivers/libOniFile.so",
                         drivers / ("libOniFile.so" + std::string{end}));
      if (with_camera) fs::create_symlink(openni2_driver(), drivers / ("libTest.so" + std::string{end}));
    }
  }
  [[nodiscard]] std::string environment() const { return "LD_LIBRARY_PATH=" + quoted(folder_.path()); }
  [[nodiscard]] std::string camera(const std::string& options = "") const {
    return device_command("openni2-camera", environment(), options);
  }

 private:
  TempFolder folder_;
};

class OpenNi2Program : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(device_program("openni2-camera"))) GTEST_SKIP() << "not built, for lack of libopenni2-dev";
  }
};

/// The first two pixels are special; the picture must not be mirrored.
void expect_pattern(const Frame& frame, bool color) {
  EXPECT_FLOAT_EQ(frame.depth(2, 0), 1.002F);
  EXPECT_FLOAT_EQ(frame.depth(79, 59), 1.197F);
  ASSERT_EQ(frame.color.has_value(), color);
  if (color) {
    EXPECT_EQ((*frame.color)(79, 59), (Rgb8{79, 59, 7}));
  }
}

TEST_F(OpenNi2Program, GivesDepthInTheViewOfColour) {
  const OpenNi2 openni2{true};
  auto camera = started(openni2.camera());
  ASSERT_TRUE(camera);
  const double focal_px = 80.0 / std::tan(0.6);  // colour sees 1.2 rad, depth 1 rad
  EXPECT_EQ(camera->intrinsics().width, 160);
  EXPECT_EQ(camera->intrinsics().height, 120);
  EXPECT_NEAR(camera->intrinsics().fx, focal_px, 1e-4);
  EXPECT_EQ(camera->intrinsics().fx, camera->intrinsics().fy);
  EXPECT_EQ(camera->intrinsics().cx, 79.5);
  for (int i = 0; i < 4; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds{35});  // frames come meanwhile
    const long asked_ms = clock_ms();
    const auto frame = camera->capture(Pose::Identity());
    ASSERT_TRUE(frame.ok()) << frame.error().to_string();
    EXPECT_GE(shown_after_ms(asked_ms, frame->depth(0, 0)), 0) << "was exposed before it was asked for";
    EXPECT_FLOAT_EQ(frame->depth(1, 0), 1.1F) << "depth is not registered to colour";
    expect_pattern(*frame, true);
  }
}

TEST_F(OpenNi2Program, WithoutColourDepthIsItsOwn) {
  const OpenNi2 openni2{true};
  auto camera = started(openni2.camera("saccade-test --color 0 --width 80 --cx 40 --max-range 3"));
  ASSERT_TRUE(camera);
  const double focal_px = 40.0 / std::tan(0.5);
  EXPECT_EQ(camera->intrinsics().width, 80);
  EXPECT_NEAR(camera->intrinsics().fx, focal_px, 1e-4);
  EXPECT_EQ(camera->intrinsics().cx, 40.0);
  EXPECT_EQ(camera->intrinsics().max_range_m, 3.0);
  const auto frame = camera->capture(Pose::Identity());
  ASSERT_TRUE(frame.ok()) << frame.error().to_string();
  EXPECT_FLOAT_EQ(frame->depth(1, 0), 1.05F);
  expect_pattern(*frame, false);
}

TEST_F(OpenNi2Program, PlaysARecording) {
  const OpenNi2 openni2{true};
  const TempFolder folder;
  const fs::path file = folder / "a.oni";
  const std::string record = "env " + openni2.environment() + " " + quoted(openni2_recorder()) + " " + quoted(file);
  ASSERT_EQ(std::system(record.c_str()), 0) << record;
  const OpenNi2 player{false};
  for (const bool color : {false, true}) {
    auto camera = started(player.camera(quoted(file) + (color ? " --color 1" : "")));
    ASSERT_TRUE(camera);
    EXPECT_NEAR(camera->intrinsics().fx, 80.0 / std::tan(color ? 0.6 : 0.5), 1e-4);
    for (int i = 0; i < 2; ++i) {
      const auto frame = camera->capture(Pose::Identity());
      ASSERT_TRUE(frame.ok()) << frame.error().to_string();
      expect_pattern(*frame, color);
    }
  }
}

TEST_F(OpenNi2Program, SaysWhatIsWrong) {
  const OpenNi2 openni2{false};
  const std::string none = refusal(openni2.camera());
  for (const char* words : {"OpenNI2 finds no camera", "plugged in", "udev"}) {
    EXPECT_NE(none.find(words), std::string::npos) << none;
  }
  EXPECT_NE(refusal(openni2.camera("/nowhere.oni")).find("there is no file /nowhere.oni"), std::string::npos);
  const TempFolder folder;
  const std::string junk = folder.write("junk.oni", "no recording").string();
  EXPECT_NE(refusal(openni2.camera(junk)).find("junk.oni cannot be opened"), std::string::npos);
  EXPECT_NE(refusal(openni2.camera("1d27/0601@1/2")).find("the camera 1d27/0601@1/2 cannot be opened"),
            std::string::npos);
}

}  // namespace
}  // namespace saccade::test
