// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/messages/messages.hpp"

#include <gtest/gtest.h>

namespace saccade::messages {
namespace {

std::string hex_of(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte byte : bytes) {
    constexpr std::string_view kDigits{"0123456789abcdef"};
    text += kDigits[std::to_integer<unsigned>(byte) >> 4];
    text += kDigits[std::to_integer<unsigned>(byte) & 15];
  }
  return text;
}

JointState two_joints() {
  JointState state;
  state.header = {{5, 6}, "base"};
  state.name = {"a", "bc"};
  state.position = {1.5, -2.0};
  return state;
}

Marker a_marker() {
  Marker marker;
  marker.header = {{1, 2}, "world"};
  marker.ns = "n";
  marker.type = Marker::line_list;
  marker.points = {{1, 2, 3}, {4, 5, 6}};
  marker.colors = {{0.1F, 0.2F, 0.3F, 0.4F}};
  marker.text = "t";
  marker.mesh_use_embedded_materials = true;
  return marker;
}

// As genpy 0.6 serialises this message; its seq is 7 there and 0 here.
TEST(Messages, ARosOneMessageHasTheBytesOfGenpy) {
  EXPECT_EQ(hex_of(write_message(Wire::ros1, two_joints())),
            "000000000500000006000000040000006261736502000000010000006102000000626302000000"
            "000000000000f83f00000000000000c00000000000000000");
}

// XCDR1 worked out by hand: strings end with a zero, numbers stand at multiples of their size behind the first four
// bytes.
TEST(Messages, CdrPadsAndEndsStringsWithAZero) {
  EXPECT_EQ(hex_of(write_message(Wire::cdr, two_joints())),
            "00010000"
            "05000000"
            "06000000"
            "05000000"
            "6261736500"
            "000000"
            "02000000"
            "02000000"
            "6100"
            "0000"
            "03000000"
            "626300"
            "00"
            "02000000"
            "00000000"
            "000000000000f83f"
            "00000000000000c0"
            "00000000"
            "00000000");
}

TEST(Messages, WhatIsWrittenIsReadAgain) {
  CameraInfo info;
  info.header = {{-1, 999'999'999}, "camera"};
  info.width = 640;
  info.d = {0.1, 0.2, 0.3, 0.4, 0.5};
  info.k = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  info.p[11] = 12.0;
  info.roi.do_rectify = true;
  for (const Wire wire : {Wire::ros1, Wire::cdr}) {
    const auto bytes = write_message(wire, info);
    const auto read = read_message<CameraInfo>(wire, bytes);
    ASSERT_TRUE(read.ok()) << read.error().to_string();
    EXPECT_EQ(read->header.stamp.sec, wire == Wire::cdr ? std::int64_t{-1} : 0xffffffff);
    EXPECT_EQ(read->d, info.d);
    EXPECT_EQ(read->k, info.k);
    EXPECT_EQ(read->p, info.p);
    EXPECT_TRUE(read->roi.do_rectify);
    EXPECT_EQ(write_message(wire, *read), bytes);

    const auto markers = write_message(wire, MarkerArray{{a_marker(), a_marker()}});
    const auto read_markers = read_message<MarkerArray>(wire, markers);
    ASSERT_TRUE(read_markers.ok());
    EXPECT_EQ(read_markers->markers[1].points[1].z, 6.0);
    EXPECT_EQ(read_markers->markers[1].text, "t");
    EXPECT_TRUE(read_markers->markers[1].mesh_use_embedded_materials);
    EXPECT_EQ(write_message(wire, *read_markers), markers);
  }
}

TEST(Messages, CdrOfTheOtherByteOrderIsRead) {
  const std::string_view big{
      "\x00\x00\x00\x00\x00\x00\x00\x03"
      "ab\x00",
      11};
  const auto read = read_message<String>(Wire::cdr, std::as_bytes(std::span{big}));
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->data, "ab");
  const std::string_view extended{
      "\x00\x07\x00\x00\x00\x00\x00\x03"
      "ab\x00",
      11};
  EXPECT_EQ(read_message<String>(Wire::cdr, std::as_bytes(std::span{extended})).error().code, Errc::unsupported);
}

TEST(Messages, BytesThatEndEarlyAndLengthsThatCannotBeAreErrors) {
  for (const Wire wire : {Wire::ros1, Wire::cdr}) {
    auto bytes = write_message(wire, two_joints());
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      const auto read = read_message<JointState>(wire, std::span{bytes}.first(length));
      ASSERT_FALSE(read.ok()) << length;
      EXPECT_EQ(read.error().code, Errc::corrupt_data);
    }
    EXPECT_NE(read_message<JointState>(wire, {}).error().to_string().find("sensor_msgs/JointState"), std::string::npos);
    bytes[12] = std::byte{0xff};  // length of frame_id
    bytes[15] = std::byte{0xff};
    EXPECT_FALSE(read_message<JointState>(wire, bytes).ok());
  }
}

TEST(Messages, TimesRoundToNanoseconds) {
  EXPECT_EQ(Time::from_seconds(-0.25), (Time{-1, 750'000'000}));
  EXPECT_EQ(Time::from_seconds(1.9999999999), (Time{2, 0}));
  EXPECT_DOUBLE_EQ((Time{3, 500'000'000}).seconds(), 3.5);
}

TEST(Messages, TypesHaveTheirNamesAndDefinitions) {
  const MessageType& type = type_of<MarkerArray>();
  EXPECT_EQ(type.ros2_name(), "visualization_msgs/msg/MarkerArray");
  EXPECT_EQ(type.dds_name(), "visualization_msgs::msg::dds_::MarkerArray_");
  const std::string ros1 = type.definition(Wire::ros1);
  const std::string ros2 = type.definition(Wire::cdr);
  EXPECT_NE(ros1.find("MSG: std_msgs/Header\nuint32 seq\ntime stamp\n"), std::string::npos) << ros1;
  EXPECT_NE(ros2.find("MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\n"), std::string::npos) << ros2;
  EXPECT_NE(ros2.find("MSG: builtin_interfaces/Duration\nint32 sec\n"), std::string::npos) << ros2;
  EXPECT_EQ(ros1.find("uv_coordinates"), std::string::npos);
  EXPECT_NE(ros2.find("UVCoordinate[] uv_coordinates"), std::string::npos);
}

}  // namespace
}  // namespace saccade::messages
