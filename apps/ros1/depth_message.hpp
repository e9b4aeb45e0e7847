// SPDX-License-Identifier: Apache-2.0
#pragma once
// DepthMessage: the bytes of a depth image in a message. to_metres: conversion to metres.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace saccade::ros1 {

/// Borrowed sensor_msgs/Image.
struct DepthMessage {
  std::uint32_t width{0};
  std::uint32_t height{0};
  std::string encoding;
  bool is_bigendian{false};
  std::uint32_t step{0};  ///< bytes of a row, padding included
  const std::uint8_t* data{nullptr};
  std::size_t bytes{0};
};

/// Converts depth to metres along z: 16UC1 and mono16 are millimetres, 32FC1 metres; 0: no return; negative: seen free
/// up to there.
/// @return an error text; empty for a sound message.
[[nodiscard]] std::string to_metres(const DepthMessage& message, std::vector<float>& metres);

}  // namespace saccade::ros1
