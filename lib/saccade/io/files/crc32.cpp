// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/crc32.hpp"

#include <zlib.h>

namespace saccade {

std::uint32_t crc32(std::span<const std::byte> head, std::span<const std::byte> tail) {
  const auto extend = [](uLong crc, std::span<const std::byte> bytes) {
    // A null pointer would start anew.
    return bytes.empty() ? crc : ::crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  };
  return static_cast<std::uint32_t>(extend(extend(0, head), tail));
}

}  // namespace saccade
