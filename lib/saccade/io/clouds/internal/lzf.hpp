// SPDX-License-Identifier: Apache-2.0
#pragma once
// The LZF compression of PCD's binary_compressed data.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace saccade {

/// Largest expansion of a byte by LZF (three bytes stand for at most 264).
constexpr std::size_t kLzfMaxExpansion{88};

/// Returns the original of exactly `size` bytes, or nullopt when the data is damaged or has another length.
[[nodiscard]] std::optional<std::vector<std::byte>> lzf_decompress(std::span<const std::byte> packed, std::size_t size);
/// Compresses; never fails. Incompressible data grows by 1/32 at most, plus a byte.
[[nodiscard]] std::vector<std::byte> lzf_compress(std::span<const std::byte> data);

}  // namespace saccade
