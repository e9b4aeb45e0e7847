// SPDX-License-Identifier: Apache-2.0
// saccade-ros2 camera: images of an independent implementation, in each encoding; frames are new; faults are said.
#include <gtest/gtest.h>

#include "fast_robot.hpp"
#include "ros2_programs.hpp"

namespace saccade::test {
namespace {

constexpr std::uint32_t kWidth{40};
constexpr std::uint32_t kHeight{30};

/// 1.5 m everywhere but at pixel (3, 2), which has 0.75 m.
FastImage depth_image(const std::string& encoding, bool big_endian = false, std::uint32_t padding = 0,
                      std::uint32_t width = kWidth) {
  const std::uint32_t pixel = encoding == "32FC1" ? 4 : 2;
  FastImage image;
  image.header_(header_at(wall_s(), "camera_depth_optical_frame"));
  image.width_(width);
  image.height_(kHeight);
  image.encoding_(encoding);
  image.is_bigendian_(big_endian ? 1 : 0);
  image.step_(width * pixel + padding);
  image.data_().assign(std::size_t{image.step_()} * kHeight, 0xEE);
  for (std::uint32_t v = 0; v < kHeight; ++v) {
    for (std::uint32_t u = 0; u < width; ++u) {
      const bool near = u == 3 && v == 2;
      const float metres = near ? 0.75F : 1.5F;
      const std::uint16_t millimetres = near ? 750 : 1500;
      std::array<std::uint8_t, 4> bytes{};
      std::memcpy(bytes.data(), pixel == 4 ? static_cast<const void*>(&metres) : &millimetres, pixel);
      if (big_endian) std::reverse(bytes.begin(), bytes.begin() + pixel);
      std::copy_n(bytes.begin(), pixel, image.data_().begin() + v * image.step_() + u * pixel);
    }
  }
  return image;
}

FastInfo info() { return camera_info(kWidth, kHeight, 35.0, 19.25, 14.75); }

TEST(Ros2Camera, ReadsEachEncodingFromBothKindsOfPublishers) {
  struct Case {
    std::string encoding;
    bool big_endian;
    std::uint32_t padding;
    bool reliable;
  };
  for (const Case& c :
       {Case{"16UC1", false, 0, false}, Case{"mono16", true, 6, true}, Case{"32FC1", true, 12, false}}) {
    FastNode node;
    FastCamera camera{
        node, info(), [&] { return depth_image(c.encoding, c.big_endian, c.padding); }, {.reliable = c.reliable}};
    auto started_camera = started(ros2_command("camera /camera/depth --min-range 0.3 --max-range 3"));
    ASSERT_TRUE(started_camera) << c.encoding;
    const PinholeCamera& k = started_camera->intrinsics();
    EXPECT_EQ(k.width, 40);
    EXPECT_EQ(k.height, 30);
    EXPECT_EQ(k.fx, 35.0);
    EXPECT_EQ(k.cx, 19.25);
    EXPECT_EQ(k.cy, 14.75);
    EXPECT_EQ(k.max_range_m, 3.0);
    const double asked_s = wall_s();
    const auto frame = started_camera->capture(Pose::Identity());
    ASSERT_TRUE(frame) << frame.error().to_string();
    EXPECT_EQ(frame->depth(3, 2), 0.75F) << c.encoding;
    EXPECT_EQ(frame->depth(4, 2), 1.5F) << c.encoding;
    EXPECT_EQ(frame->depth(39, 29), 1.5F) << c.encoding;
    ASSERT_TRUE(frame->time_s);
    EXPECT_GE(*frame->time_s, asked_s);
    EXPECT_LT(*frame->time_s, asked_s + 1.0);
  }
}

TEST(Ros2Camera, AFrameIsTakenAfterTheRequestAlsoWithStampsOfAnotherClock) {
  FastNode node;
  std::atomic<double> offset_s{-0.2};  // each image arrives 0.2 s after it was taken
  FastCamera camera{node, info(), [&] {
                      FastImage image = depth_image("16UC1");
                      image.header_(header_at(wall_s() + offset_s, ""));
                      return image;
                    }};
  auto device = started(ros2_command("camera /camera/depth"));
  ASSERT_TRUE(device);
  const double asked_s = wall_s();
  const auto frame = device->capture(Pose::Identity());
  ASSERT_TRUE(frame) << frame.error().to_string();
  EXPECT_GE(*frame->time_s, asked_s);
  EXPECT_GE(wall_s() - asked_s, 0.2);
  offset_s = 1000.0 - wall_s();  // a simulation's clock: the third image that comes is answered
  std::this_thread::sleep_for(std::chrono::milliseconds{50});
  const double asked_again_s = wall_s() + offset_s;
  const auto later = device->capture(Pose::Identity());
  ASSERT_TRUE(later) << later.error().to_string();
  EXPECT_GT(*later->time_s, asked_again_s + 0.03);
  EXPECT_LT(*later->time_s, asked_again_s + 0.3);
}

TEST(Ros2Camera, FaultsAreSaid) {
  EXPECT_NE(refusal(ros2_command("camera /nothing --wait 0.2")).find("nothing publishes it"), std::string::npos);
  EXPECT_NE(
      refusal(device_command("ros2", "ROS_DOMAIN_ID=many", "camera /nothing")).find("must be 0 to 232, not 'many'"),
      std::string::npos);
  FastNode node;
  {
    FastCamera camera{node, info(), [] { return depth_image("rgb8"); }};
    EXPECT_NE(refusal(ros2_command("camera /camera/depth")).find("'rgb8' are no depth"), std::string::npos);
    const std::string again = refusal(ros2_command("camera /camera/depth --info /other"));
    EXPECT_NE(again.find("no depth"), std::string::npos) << again;
  }
  {
    FastCamera camera{node, info(), [] {
                        FastImage image = depth_image("32FC1");
                        image.data_().resize(1000);
                        return image;
                      }};
    const std::string said = refusal(ros2_command("camera /camera/depth"));
    EXPECT_NE(said.find("40x30 pixels with 160 bytes a row has 1000 bytes"), std::string::npos) << said;
  }
  {
    FastInfo distorted = info();
    distorted.d_({0.1, 0.0, 0.0, 0.0, 0.0});
    FastCamera camera{node, distorted, [] { return depth_image("16UC1"); }};
    EXPECT_NE(refusal(ros2_command("camera /camera/depth")).find("rectified"), std::string::npos);
    EXPECT_NE(refusal(ros2_command("camera /camera/depth --info /other --wait 1")).find("no camera info"),
              std::string::npos);
    EXPECT_TRUE(started(ros2_command("camera /camera/depth --rectified")));
  }
}

TEST(Ros2Camera, ATopicThatStopsOrChangesIsAnError) {
  FastNode node;
  std::atomic<std::uint32_t> width{kWidth};
  FastCamera camera{node, info(), [&] { return depth_image("16UC1", false, 0, width); }};
  auto device = started(ros2_command("camera /camera/depth --timeout 0.3"));
  ASSERT_TRUE(device);
  width = 32;
  std::this_thread::sleep_for(std::chrono::milliseconds{100});
  const auto other = device->capture(Pose::Identity());
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().to_string().find("32x30 pixels now; they were 40x30"), std::string::npos)
      << other.error().to_string();
  width = kWidth;
  EXPECT_TRUE(eventually([&] { return device->capture(Pose::Identity()).ok(); }));
  camera.silent = true;
  std::this_thread::sleep_for(std::chrono::milliseconds{100});
  const auto none = device->capture(Pose::Identity());
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().to_string().find("no image came on /camera/depth in 0.3 s"), std::string::npos)
      << none.error().to_string();
  camera.silent = false;
  EXPECT_TRUE(device->capture(Pose::Identity()));
}

}  // namespace
}  // namespace saccade::test
