// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "saccade/io/bags/bags.hpp"
#include "saccade/io/files/file_io.hpp"
#include "support/bag_writer.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

using test::BagStyle;
using test::WrittenMessage;

constexpr int kWidth{8};
constexpr int kHeight{6};
constexpr std::int64_t kFirst_ns{1'000'000'000'000};
constexpr std::int64_t kStep_ns{100'000'000};

messages::Header head_at(std::int64_t at_ns, const std::string& frame) {
  return {{at_ns / 1'000'000'000, static_cast<std::uint32_t>(at_ns % 1'000'000'000)}, frame};
}

std::uint16_t sample_at(int u, int v, int i) { return static_cast<std::uint16_t>(800 + 10 * i + 3 * u + v); }

/// Rows padded by four bytes.
messages::Image depth_message(int i, const std::string& encoding, bool big_endian) {
  messages::Image image{head_at(kFirst_ns + i * kStep_ns, "camera"), kHeight, kWidth, encoding,
                        static_cast<std::uint8_t>(big_endian),       0,       {}};
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      test::Bytes pixel;
      const std::uint16_t sample = sample_at(u, v, i);
      if (encoding == "32FC1") append_value(pixel, u == 0 ? -0.5F : static_cast<float>(sample) / 1000.0F);
      if (encoding != "32FC1") append_value(pixel, sample);
      if (big_endian) std::reverse(pixel.begin(), pixel.end());
      test::append_bytes(image.data, pixel);
    }
    image.data.resize(image.data.size() + 4);
  }
  image.step = static_cast<std::uint32_t>(image.data.size()) / kHeight;
  return image;
}

messages::CameraInfo camera_info() {
  messages::CameraInfo info;
  info.width = kWidth;
  info.height = kHeight;
  info.distortion_model = "plumb_bob";
  info.d = {0, 0, 0, 0, 0};
  info.k = {10, 0, 3.5, 0, 11, 2.5, 0, 0, 1};
  return info;
}

messages::TransformStamped transform(std::int64_t at_ns, const std::string& parent, const std::string& child,
                                     const messages::Pose& pose) {
  return {head_at(at_ns, parent), child, pose};
}

struct Recording {
  std::string encoding{"16UC1"};
  bool big_endian{false};
  messages::Wire wire{messages::Wire::ros1};
  std::vector<WrittenMessage> more;
};

/// Five frames; the camera sits on a hand that moves along x by 0.1 m per step, of which TF tells every 0.2 s.
std::vector<WrittenMessage> recording(const Recording& r) {
  std::vector<WrittenMessage> all;
  all.push_back(test::written("/tf_static", kFirst_ns - 1,
                              messages::TFMessage{{transform(0, "hand", "camera", {{0.0, 0.0, 0.25}, {}})}}, r.wire));
  for (int i = 0; i < 6; i += 2) {
    const messages::Pose pose{{0.1 * i, 1.0, 0.0}, {0.0, 0.0, 0.0, 1.0}};
    all.push_back(test::written("/tf", kFirst_ns + i * kStep_ns,
                                messages::TFMessage{{transform(kFirst_ns + i * kStep_ns, "base", "/hand", pose)}},
                                r.wire));
  }
  all.push_back(test::written("/camera/depth/camera_info", kFirst_ns, camera_info(), r.wire));
  for (int i = 0; i < 5; ++i) {
    all.push_back(test::written("/camera/depth/image_raw", kFirst_ns + i * kStep_ns + 1000,
                                depth_message(i, r.encoding, r.big_endian), r.wire));
  }
  all.insert(all.end(), r.more.begin(), r.more.end());
  return all;
}

std::vector<Frame> frames_of(RgbdFolderSource& source) {
  std::vector<Frame> frames;
  while (true) {
    auto frame = source.next();
    EXPECT_TRUE(frame) << frame.error().to_string();
    if (!frame || !*frame) return frames;
    frames.push_back(std::move(**frame));
  }
}

TEST(BagFrames, ReadsDepthsAndPosesOfEveryEncoding) {
  const test::TempFolder folder;
  int kinds = 0;
  for (const messages::Wire wire : {messages::Wire::ros1, messages::Wire::cdr}) {
    for (const char* encoding : {"16UC1", "mono16", "32FC1"}) {
      for (const bool big_endian : {false, true}) {
        const auto messages = recording({encoding, big_endian, wire, {}});
        const BagStyle style{"none", true, 4, wire};
        const auto path =
            test::write_bytes(folder / "x", wire == messages::Wire::ros1 ? test::RosbagBytes::make(messages, style)
                                                                         : test::McapBytes::make(messages, style));
        const auto source = open_bag_frames(path, {});
        ASSERT_TRUE(source) << source.error().to_string();
        EXPECT_DOUBLE_EQ((*source)->camera().fx, 10.0);
        EXPECT_EQ((*source)->info().intrinsics_from, "/camera/depth/camera_info");
        ASSERT_TRUE((*source)->info().has_poses);
        // The last frame is within TF, which ends with it.
        const auto frames = frames_of(**source);
        ASSERT_EQ(frames.size(), 5U);
        for (int i = 0; i < 5; ++i) {
          const Frame& frame = frames[static_cast<std::size_t>(i)];
          const bool is_float = std::string_view{encoding} == "32FC1";
          EXPECT_FLOAT_EQ(frame.depth(0, 2), is_float ? -0.5F : static_cast<float>(sample_at(0, 2, i)) / 1000.0F);
          EXPECT_EQ(frame.depth(3, 2), static_cast<float>(sample_at(3, 2, i)) / 1000.0F);
          ASSERT_TRUE(frame.T_world_camera);
          const Eigen::Vector3d expected{0.1 * i, 1.0, 0.25};
          EXPECT_LT((frame.T_world_camera->translation() - expected).norm(), 1e-12);
        }
        EXPECT_EQ((*source)->at(2)->depth, frames[2].depth);
        ++kinds;
      }
    }
  }
  EXPECT_EQ(kinds, 12);
}

TEST(BagFrames, ReadsCompressedDepthAndColour) {
  const test::TempFolder folder;
  Recording r;
  PngPixels png{kWidth, kHeight, 1, 16, {}};
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const std::uint16_t sample = sample_at(u, v, 0);
      png.bytes.push_back(static_cast<std::uint8_t>(sample & 0xFFU));
      png.bytes.push_back(static_cast<std::uint8_t>(sample >> 8U));
    }
  }
  const auto file = encode_png(png);
  for (const std::string kind : {"16UC1", "32FC1"}) {
    messages::CompressedImage image{head_at(kFirst_ns, "camera"), kind + "; compressedDepth", {}};
    append_value(image.data, std::int32_t{0});
    append_value(image.data, 1500.0F);
    append_value(image.data, 100.0F);
    test::append_bytes(image.data, *file);
    r.more.push_back(test::written("/packed/" + kind + "/compressedDepth", kFirst_ns, image));
  }
  messages::Image color{head_at(kFirst_ns + 5'000'000, "camera"), kHeight, kWidth, "bgr8", 0, 3 * kWidth, {}};
  for (int i = 0; i < kWidth * kHeight; ++i) test::append_chars(color.data, "\x03\x02\x01");
  r.more.push_back(test::written("/color", kFirst_ns, color));
  const auto path = test::write_bytes(folder / "x", test::RosbagBytes::make(recording(r), {}));
  BagFramesConfig config;
  config.color = "/color";
  config.depth = "/packed/16UC1/compressedDepth";
  auto source = open_bag_frames(path, config);
  ASSERT_TRUE(source) << source.error().to_string();
  auto frame = (*source)->next();
  ASSERT_TRUE(frame && *frame);
  EXPECT_EQ((*frame)->depth(3, 2), static_cast<float>(sample_at(3, 2, 0)) / 1000.0F);
  ASSERT_TRUE((*frame)->color);
  EXPECT_EQ((*(*frame)->color)(1, 1), (Rgb8{1, 2, 3}));
  config.depth = "/packed/32FC1/compressedDepth";
  source = open_bag_frames(path, config);
  ASSERT_TRUE(source) << source.error().to_string();
  EXPECT_NEAR((*source)->at(0)->depth(3, 2), 1500.0 / (sample_at(3, 2, 0) - 100.0), 1e-5);
  // With several topics of depth there is none to propose.
  config.depth.clear();
  const auto several = open_bag_frames(path, config);
  ASSERT_FALSE(several);
  EXPECT_NE(several.error().message.find("/packed/16UC1/compressedDepth (sensor_msgs/CompressedImage, 1 message)"),
            std::string::npos)
      << several.error().message;
}

TEST(BagFrames, SaysWhatIsMissing) {
  const test::TempFolder folder;
  const auto path = test::write_bytes(folder / "x", test::RosbagBytes::make(recording({}), {}));
  BagFramesConfig config;
  config.depth = "/nowhere";
  EXPECT_NE(open_bag_frames(path, config)
                .error()
                .message.find("it has these image topics: /camera/depth/image_raw (sensor_msgs/Image, 5 messages)"),
            std::string::npos);
  config = {};
  config.world_frame = "map";
  EXPECT_NE(open_bag_frames(path, config).error().message.find("TF knows no frame map"), std::string::npos);
}

TEST(BagHand, ReadsFramesAndTopics) {
  const test::TempFolder folder;
  Recording r;
  for (int i = 0; i < 3; ++i) {
    const std::int64_t at = kFirst_ns + i * kStep_ns;
    r.more.push_back(test::written("/glove", at, messages::PointStamped{head_at(at, "hand"), {0.0, 0.0, 2.0}}));
  }
  const auto path = test::write_bytes(folder / "x", test::RosbagBytes::make(recording(r), {}));
  const auto by_tf = read_bag_hand(path, "/camera", "");
  ASSERT_TRUE(by_tf) << by_tf.error().to_string();
  ASSERT_EQ(by_tf->trajectory.size(), 3U);
  EXPECT_LT((by_tf->trajectory[1].position_m - Eigen::Vector3d{0.2, 1.0, 0.25}).norm(), 1e-12);
  const auto by_topic = read_bag_hand(path, "", "base");
  ASSERT_TRUE(by_topic) << by_topic.error().to_string();
  ASSERT_EQ(by_topic->trajectory.size(), 3U);
  EXPECT_LT((by_topic->trajectory[1].position_m - Eigen::Vector3d{0.1, 1.0, 2.0}).norm(), 1e-12);
  EXPECT_FALSE(read_bag_hand(path, "/nowhere", ""));
}

}  // namespace
}  // namespace saccade
