// SPDX-License-Identifier: Apache-2.0
// saccade-kinect1-camera, without a Kinect: with fakenect, which plays a recording, and with a library in place of
// libfreenect.
#include <cstring>
#include <thread>

#include "../../devices/kinect1_depth.hpp"
#include "device_programs.hpp"

namespace saccade::test {
namespace {

/// A recording as fakenect-record writes it: one image for each of 12 frames, again and again.
class Recording {
 public:
  explicit Recording(int frames) {
    std::string index;
    for (int i = 0; i < frames; ++i) {
      const std::string name = "d-" + std::to_string(1000.0 + i / 30.0) + "-" + std::to_string(i * 2000000L) + ".pgm";
      if (i < kDifferent) {
        write_image(name, i);
        names_.push_back(name);
      } else {
        fs::create_hard_link(folder_ / names_[static_cast<std::size_t>(i % kDifferent)], folder_ / name);
      }
      index += name + "\n";
    }
    folder_.write("INDEX.txt", index);
  }
  [[nodiscard]] std::string environment() const {
    return "LD_LIBRARY_PATH=" SACCADE_FAKENECT " FAKENECT_PATH=" + quoted(folder_.path());
  }
  static constexpr int kDifferent{12};
  static std::uint16_t raw(int image) { return static_cast<std::uint16_t>(700 + 20 * image); }

 private:
  /// 11 bits as the device sends them: raw(i) everywhere but at a few pixels of the first row.
  void write_image(const std::string& name, int i) const {
    std::vector<std::uint16_t> pixels(640 * 480, raw(i));
    const std::uint16_t first[]{600, 1000, 2047, 1093, 100};
    std::memcpy(pixels.data(), first, sizeof first);
    folder_.write(name,
                  "P5 640 480 65535\n" + std::string{reinterpret_cast<const char*>(pixels.data()), 2 * pixels.size()});
  }

  TempFolder folder_;
  std::vector<std::string> names_;
};

std::string kinect(const std::string& environment, const std::string& options = "") {
  return device_command("kinect1-camera", environment, options);
}
std::string stubbed(const std::string& more = "") { return "LD_PRELOAD=" + quoted(kinect1_stub()) + " " + more; }

class Kinect1Program : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(device_program("kinect1-camera"))) GTEST_SKIP() << "not built, for lack of libfreenect-dev";
  }
};

TEST_F(Kinect1Program, PlaysARecordingOfFakenect) {
  if (!fs::exists(SACCADE_FAKENECT)) GTEST_SKIP() << "there is no " SACCADE_FAKENECT;
  const Recording recording{150};
  auto camera = started(kinect(recording.environment()));
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->intrinsics().width, 640);
  EXPECT_EQ(camera->intrinsics().height, 480);
  EXPECT_NEAR(camera->intrinsics().fx, 575.8, 0.1);
  EXPECT_EQ(camera->intrinsics().min_range_m, 0.4);
  int last = -1;
  for (int i = 0; i < 4; ++i) {
    const auto frame = camera->capture(Pose::Identity());
    ASSERT_TRUE(frame.ok()) << frame.error().to_string();
    // 9 m / (7.5 − 0.1042 ((raw − 800) / 4 − 0.375)), worked out by hand.
    EXPECT_FLOAT_EQ(frame->depth(0, 0), 0.706F);
    EXPECT_FLOAT_EQ(frame->depth(1, 0), 3.864F);
    EXPECT_EQ(frame->depth(2, 0), 0.0F);  // no return
    EXPECT_EQ(frame->depth(3, 0), 0.0F);  // beyond anything
    EXPECT_EQ(frame->depth(4, 0), 0.0F);  // nearer than 0.4 m
    int image = 0;
    const auto expected = [&] { return 9.0 / (7.5 - 0.1042 * ((Recording::raw(image) - 800) / 4.0 - 0.375)); };
    while (image < Recording::kDifferent && std::abs(expected() - frame->depth(320, 240)) > 0.0006) ++image;
    ASSERT_LT(image, Recording::kDifferent) << frame->depth(320, 240);
    // Two frames are passed over, at least: one is on its way, one is being exposed.
    if (last >= 0) {
      EXPECT_GE((image - last + 2 * Recording::kDifferent - 1) % Recording::kDifferent, 2) << i;
    }
    last = image;
  }
}

TEST_F(Kinect1Program, GivesRegisteredDepthWithColour) {
  auto camera = started(kinect(stubbed()));
  ASSERT_TRUE(camera);
  EXPECT_NEAR(camera->intrinsics().fx, 0.9 * 600.0, 0.5);  // the spread of rows, times 1.2 m / (2 × 1 mm)
  EXPECT_EQ(camera->intrinsics().fy, camera->intrinsics().fx);
  for (int i = 0; i < 3; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds{150});
    const long asked_ms = clock_ms();
    const auto frame = camera->capture(Pose::Identity());
    ASSERT_TRUE(frame.ok()) << frame.error().to_string();
    EXPECT_GE(shown_after_ms(asked_ms, frame->depth(0, 0)), 0) << "was exposed before it was asked for";
    EXPECT_LT(frame->depth(1, 0), 1.1F) << "events were left alone, so that old frames pile up";
    EXPECT_FLOAT_EQ(frame->depth(639, 479), 2.597F);
    ASSERT_TRUE(frame->color.has_value());
    EXPECT_EQ((*frame->color)(639, 479), (Rgb8{159, 239, 9}));
    EXPECT_EQ((*frame->color)(100, 20), (Rgb8{25, 10, 9}));
  }
}

TEST_F(Kinect1Program, TakesIntrinsicsThatAreGiven) {
  auto camera = started(kinect(stubbed(), "--fx 530 --fy 531 --cx 322.5 --cy 240.5"));
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->intrinsics(), (PinholeCamera{640, 480, 530.0, 531.0, 322.5, 240.5, 0.4, 4.5}));
}

TEST_F(Kinect1Program, SaysWhatIsWrong) {
  const std::string none = refusal(kinect(""));
  if (none != "it started") {  // as where a Kinect is plugged in
    for (const char* words : {"No Kinect found", "plugged in", "udev"}) {
      EXPECT_NE(none.find(words), std::string::npos) << none;
    }
  }
  EXPECT_NE(refusal(kinect(stubbed(), "--index 3")).find("there is no Kinect 3, only 1"), std::string::npos);
  EXPECT_NE(refusal(kinect(stubbed(), "--depth mm")).find("--depth must be"), std::string::npos);
  EXPECT_NE(refusal(kinect(stubbed(), "--fx wide")).find("--fx must be a number"), std::string::npos);
  EXPECT_NE(refusal(kinect(stubbed(), "--focal 3")).find("unknown option --focal"), std::string::npos);
  auto dying = started(kinect(stubbed("KINECT_DIES=5")));
  ASSERT_TRUE(dying);
  std::string error;
  for (int i = 0; i < 3; ++i) {
    const auto frame = dying->capture(Pose::Identity());
    if (!frame) error = frame.error().message;
  }
  EXPECT_NE(error.find("the Kinect is gone"), std::string::npos) << error;
}

TEST(Kinect1Depth, FocalLengthOfColourIsThatOfDepthTimesTheSpreadOfRows) {
  const auto table = std::make_unique<std::int32_t[][2]>(devices::kKinectWidth * devices::kKinectHeight);
  for (int i = 0; i < devices::kKinectWidth * devices::kKinectHeight; ++i) {
    const int row = i / devices::kKinectWidth;
    const int column = i % devices::kKinectWidth;
    table[static_cast<std::size_t>(i)][1] = static_cast<int>(20.0 + 0.9155 * row + 0.013 * column);
  }
  EXPECT_NEAR(devices::focal_of_color_px(575.8, table.get()), 0.9155 * 575.8, 1.0);
}

}  // namespace
}  // namespace saccade::test
