// SPDX-License-Identifier: Apache-2.0
#include "depth_message.hpp"

#include <cstring>

namespace saccade::ros1 {
namespace {

std::uint16_t swapped(std::uint16_t value) { return static_cast<std::uint16_t>(value << 8 | value >> 8); }

float to_metre(std::uint16_t millimetres) {
  return millimetres == 65535 ? 0.0F : 0.001F * static_cast<float>(millimetres);
}
float to_metre(float metres) { return metres; }

template <class Value>
Value read(const std::uint8_t* bytes, bool is_bigendian) {
  if constexpr (sizeof(Value) == 2) {
    Value value;
    std::memcpy(&value, bytes, sizeof(value));
    return is_bigendian ? swapped(value) : value;
  } else {
    std::uint32_t bits;
    std::memcpy(&bits, bytes, sizeof(bits));
    if (is_bigendian) bits = __builtin_bswap32(bits);
    Value value;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }
}

template <class Value>
std::string convert(const DepthMessage& message, std::vector<float>& metres) {
  const std::size_t row = std::size_t{message.width} * sizeof(Value);
  if (message.step < row) {
    return "a row has " + std::to_string(message.step) + " bytes, " + std::to_string(message.width) + " pixels need " +
           std::to_string(row);
  }
  const std::size_t needed = message.height == 0 ? 0 : std::size_t{message.step} * (message.height - 1) + row;
  if (message.bytes < needed) {
    return "it has " + std::to_string(message.bytes) + " bytes, its size needs " + std::to_string(needed);
  }
  metres.resize(std::size_t{message.width} * message.height);
  float* out = metres.data();
  for (std::uint32_t v = 0; v < message.height; ++v) {
    const std::uint8_t* in = message.data + std::size_t{message.step} * v;
    for (std::uint32_t u = 0; u < message.width; ++u, in += sizeof(Value))
      *out++ = to_metre(read<Value>(in, message.is_bigendian));
  }
  return {};
}

}  // namespace

std::string to_metres(const DepthMessage& message, std::vector<float>& metres) {
  if (message.width == 0 || message.height == 0 || message.width > 16384 || message.height > 16384) {
    return "its size of " + std::to_string(message.width) + " x " + std::to_string(message.height) +
           " pixels cannot be";
  }
  if (message.encoding == "16UC1" || message.encoding == "mono16") return convert<std::uint16_t>(message, metres);
  if (message.encoding == "32FC1") return convert<float>(message, metres);
  return "its encoding is '" + message.encoding + "', which is none of 16UC1, mono16 and 32FC1";
}

}  // namespace saccade::ros1
