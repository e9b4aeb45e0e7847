// SPDX-License-Identifier: Apache-2.0
#include "saccade/devices/internal/process_messages.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/files/text_scan.hpp"
#include "support/places.hpp"

namespace saccade {
namespace {

template <class Outcome>
void expect_refused(const Outcome& outcome, Errc code, const std::string& words) {
  ASSERT_FALSE(outcome.ok()) << words;
  EXPECT_EQ(outcome.error().code, code) << outcome.error().to_string();
  EXPECT_NE(outcome.error().to_string().find(words), std::string::npos) << outcome.error().to_string();
}

/// A good answer to hello with one key set to something else, or taken away.
std::string hello_with(const std::string& key, const std::string& value) {
  nlohmann::json hello = nlohmann::json::parse(
      R"({"saccade": 1, "width": 4, "height": 2, "fx": 5, "fy": 5, "cx": 2, "cy": 1, "min_range_m": 0.1,
          "max_range_m": 3, "depth": "uint16_mm", "color": "none", "name": "unknown keys are passed over"})");
  if (value.empty()) {
    hello.erase(key);
  } else {
    hello[key] = nlohmann::json::parse(value);
  }
  return hello.dump();
}

TEST(ProcessMessages, HelloOfACamera) {
  const auto format = parse_camera_hello(hello_with("color", R"("rgb8")"));
  ASSERT_TRUE(format.ok()) << format.error().to_string();
  EXPECT_EQ(format->camera, (PinholeCamera{4, 2, 5.0, 5.0, 2.0, 1.0, 0.1, 3.0}));
  EXPECT_EQ(format->depth, ProgramDepth::uint16_mm);
  EXPECT_EQ(format->color, ProgramColor::rgb8);
  EXPECT_EQ(format->frame_bytes(), 8U * 5U);
  EXPECT_EQ(parse_camera_hello(hello_with("depth", R"("float32_m")"))->frame_bytes(), 8U * 4U);
}

TEST(ProcessMessages, BadHellosAreRefused) {
  const auto refused = [](const std::string& key, const std::string& value, Errc code, const std::string& words) {
    expect_refused(parse_camera_hello(hello_with(key, value)), code, words);
  };
  for (const char* key : {"saccade", "width", "height", "fx", "fy", "cx", "cy", "min_range_m", "max_range_m"}) {
    refused(key, "", Errc::corrupt_data, std::string{"the key "} + key + " is missing");
  }
  refused("saccade", "2", Errc::unsupported, "another version of the protocol: saccade must be 1, not 2");
  for (const char* width : {"-1", "0", "4.5", "\"4\"", "20000", "99999999999999999999", "null", "[4]"}) {
    refused("width", width, Errc::corrupt_data, "width must be an integer within 1 and");
  }
  refused("fx", "0", Errc::corrupt_data, "focal lengths must not be 0");
  refused("fx", "-5", Errc::unsupported, "mirrors an axis");
  refused("cy", "\"1\"", Errc::corrupt_data, "cy is not a number");
  refused("max_range_m", "0.05", Errc::invalid_argument, "0 <= min < max");
  refused("depth", "\"feet\"", Errc::corrupt_data, R"(depth must be "float32_m" or "uint16_mm")");
  refused("depth", "", Errc::corrupt_data, R"(depth must be "float32_m" or "uint16_mm")");
  refused("color", "3", Errc::corrupt_data, R"(color must be "none" or "rgb8")");
  refused("distortion", R"({"k1": 0.1})", Errc::unsupported, "undistorted");
  refused("error", "\"no\\ncamera\"", Errc::unavailable, "no camera");
  refused("error", "5", Errc::corrupt_data, "error must be a text");
  std::string large = hello_with("width", "16384");
  large.replace(large.find("\"height\":2"), 10, "\"height\":16384");
  for (const char* key : {"\"fx\":5", "\"fy\":5"}) large.replace(large.find(key), 6, std::string{key} + "000");
  expect_refused(parse_camera_hello(large), Errc::corrupt_data, "a frame of 536870912 bytes is more than");
  expect_refused(parse_camera_hello("[1]"), Errc::corrupt_data, "it is not a JSON object: '[1]'");
  expect_refused(parse_camera_hello(R"({"saccade": 1, "cx": 1e999})"), Errc::corrupt_data, "it is not JSON");
  expect_refused(parse_ready("hi\x01\xFF"), Errc::corrupt_data, "it is not JSON: 'hi ?'");
  expect_refused(parse_ready("{}"), Errc::corrupt_data, "the key saccade is missing");
  EXPECT_TRUE(parse_ready(R"({"saccade": 1})").ok());
}

TEST(ProcessMessages, BadCapturesAreRefused) {
  const auto refused = [](const std::string& line, Errc code, const std::string& words) {
    expect_refused(parse_capture_answer(line, 7, 16, Pose::Identity()), code, words);
  };
  EXPECT_TRUE(parse_capture_answer(R"({"number": 7, "bytes": 16})", 7, 16, Pose::Identity()).ok());
  refused("", Errc::corrupt_data, "it is not JSON: ''");
  refused(R"({"number": 6, "bytes": 16})", Errc::corrupt_data, "number must be 7, not 6");
  refused(R"({"bytes": 16})", Errc::corrupt_data, "the key number is missing");
  refused(R"({"number": 7})", Errc::corrupt_data, "the key bytes is missing");
  refused(R"({"number": 7, "bytes": 15})", Errc::size_mismatch, "bytes must be 16, not 15");
  refused(R"({"number": 7, "bytes": -16})", Errc::corrupt_data, "bytes must be an integer that is not negative");
  refused(R"({"number": 7, "bytes": 16, "time_s": "now"})", Errc::corrupt_data, "time_s must be a number");
  refused(R"({"number": 7, "bytes": 16, "T_world_camera": 3})", Errc::corrupt_data, "4x4 nested array");
  refused(R"({"number": 7, "bytes": 16, "T_world_camera": [[2,0,0,7],[0,1,0,8],[0,0,1,9],[0,0,0,1]]})",
          Errc::invalid_argument, "T_world_camera: the pose is not a rotation");
  refused(R"({"number": 7, "bytes": 16, "T_world_camera": [[1,0,0,0],[0,1,0,800],[0,0,1,0],[0,0,0,1]]})",
          Errc::corrupt_data, "T_world_camera is 800 m from the pose that was asked for");
}

TEST(ProcessMessages, BadMovesAreRefused) {
  const Pose T_world_camera{Eigen::Translation3d{1.0, 2.0, 3.0}};
  const auto refused = [&](const std::string& line, Errc code, const std::string& words) {
    expect_refused(parse_move_answer(line, 3, T_world_camera), code, words);
  };
  refused(R"({"number": 2, "reached": true})", Errc::corrupt_data, "number must be 3, not 2");
  refused(R"({"number": 3})", Errc::corrupt_data, "reached must be true or false");
  refused(R"({"number": 3, "reached": 1})", Errc::corrupt_data, "reached must be true or false");
  refused(R"({"number": 3, "reached": false, "why": 4})", Errc::corrupt_data, "why must be a text");
  refused(R"({"number": 3, "reached": true, "T_world_camera": [[1,0,0,0]]})", Errc::corrupt_data, "4x4 nested array");
  refused(R"({"number": 3, "reached": true, "T_world_camera": [[1,0,0,801],[0,1,0,2],[0,0,1,3],[0,0,0,1]]})",
          Errc::corrupt_data, "800 m");
  const auto there = parse_move_answer(R"({"number": 3, "reached": true})", 3, T_world_camera);
  ASSERT_TRUE(there.ok() && there->T_world_camera.has_value());
  EXPECT_TRUE(there->T_world_camera->isApprox(T_world_camera));
  const auto not_there = parse_move_answer(R"({"number": 3, "reached": false, "why": "too\tfar"})", 3, T_world_camera);
  ASSERT_TRUE(not_there.ok());
  EXPECT_FALSE(not_there->T_world_camera.has_value());
  EXPECT_EQ(not_there->why, "too far");
}

TEST(ProcessMessages, DepthInMetresAndColor) {
  ProgramCameraFormat format;
  format.camera = {3, 2, 5.0, 5.0, 1.0, 0.5, 0.1, 3.0};
  format.color = ProgramColor::rgb8;
  const std::vector<float> sent{
      1.5F, std::numeric_limits<float>::quiet_NaN(), -2.0F, std::numeric_limits<float>::infinity(), 0.05F, -9.0F};
  std::vector<std::byte> bytes(format.frame_bytes());
  std::memcpy(bytes.data(), sent.data(), sent.size() * sizeof(float));
  for (std::size_t i = 24; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i);
  const Frame frame = decode_frame(format, bytes);
  EXPECT_EQ(frame.depth, (DepthImage{3, 2, {1.5F, 0.0F, -2.0F, 0.0F, 0.0F, -3.0F}}));
  ASSERT_TRUE(frame.color.has_value());
  EXPECT_EQ((*frame.color)(0, 0), (Rgb8{24, 25, 26}));
  EXPECT_EQ((*frame.color)(2, 1), (Rgb8{39, 40, 41}));
}

/// docs/guides/processes.md shows what is so: "→ " is what Saccade writes, "← " what it understands.
TEST(ProcessMessages, TheTranscriptInTheDocumentIsSo) {
  const auto document = read_text_file(test::source_folder() / "docs/guides/processes.md");
  ASSERT_TRUE(document.ok());
  int requests = 0;
  int answers = 0;
  nlohmann::json asked;
  LineScanner lines{*document};
  while (const auto line = lines.next()) {
    if (line->starts_with("→ {")) {
      ++requests;
      asked = nlohmann::json::parse(line->substr(std::strlen("→ ")));
      const std::string kind = asked.at("request");
      if (kind == "hello") {
        EXPECT_EQ(asked, nlohmann::json::parse(hello_request(std::string{asked.at("role")})));
        continue;
      }
      const auto pose = pose_from_json(asked.at("T_world_camera"));
      ASSERT_TRUE(pose.ok()) << *line;
      const std::size_t number = asked.at("number");
      EXPECT_EQ(asked, nlohmann::json::parse(kind == "capture" ? capture_request(number, *pose)
                                                               : move_request(number, *pose)));
    } else if (line->starts_with("← {")) {
      ++answers;
      const std::string_view text = line->substr(std::strlen("← "));
      const std::string kind = asked.at("request");
      if (kind == "hello" && asked.at("role") == "camera") {
        const auto format = parse_camera_hello(text);
        EXPECT_TRUE(format.ok() && format->frame_bytes() == 76800) << text;
      } else if (kind == "hello") {
        EXPECT_TRUE(parse_ready(text).ok()) << text;
      } else if (text.find("error") != std::string_view::npos) {
        expect_refused(parse_move_answer(text, asked.at("number"), Pose::Identity()), Errc::unavailable, "");
      } else if (kind == "capture") {
        EXPECT_TRUE(parse_capture_answer(text, asked.at("number"), 76800, Pose::Identity()).ok()) << text;
      } else {
        EXPECT_TRUE(parse_move_answer(text, asked.at("number"), *pose_from_json(asked.at("T_world_camera"))).ok())
            << text;
      }
    }
  }
  EXPECT_GE(requests, 6);
  EXPECT_GE(answers, 6);
}

}  // namespace
}  // namespace saccade
