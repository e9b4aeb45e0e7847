// SPDX-License-Identifier: Apache-2.0
#pragma once
// The LZF compression of PCD's binary_compressed data.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace saccade {

/// LZF expands a byte at most so many times (three bytes stand for at most 264).
constexpr std::size_t kLzfMaxExpansion{88};

/// The original of exactly `size` bytes, or nullopt when the data is damaged or stands for another number of bytes.
[[nodiscard]] std::optional<std::vector<std::byte>> lzf_decompress(std::span<const std::byte> packed, std::size_t size);
/// Never fails; data that does not compress grows by 1/32 at most, plus a byte.
[[nodiscard]] std::vector<std::byte> lzf_compress(std::span<const std::byte> data);

}  // namespace saccade
