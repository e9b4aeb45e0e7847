// SPDX-License-Identifier: Apache-2.0
#pragma once
// crc32: the checksum of zlib, over one or two pieces of memory.

#include <cstddef>
#include <cstdint>
#include <span>

namespace saccade {

/// Returns the CRC-32, as in zlib and PNG, of `head` followed by `tail`.
[[nodiscard]] std::uint32_t crc32(std::span<const std::byte> head, std::span<const std::byte> tail = {});

}  // namespace saccade
