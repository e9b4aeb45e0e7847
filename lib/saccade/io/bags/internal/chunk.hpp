// SPDX-License-Identifier: Apache-2.0
#pragma once
// unpack_chunk: decompresses bz2, lz4 or zstd.

#include <cstdint>
#include <span>
#include <string_view>

#include "saccade/core/result.hpp"
#include "saccade/core/uninitialized_vector.hpp"

namespace saccade::internal::io_bags {

enum class Packing : std::uint8_t { none, bz2, lz4, zstd, other };
/// Accepts "" and "none", "bz2", "lz4", "zstd".
[[nodiscard]] Packing packing_of(std::string_view name);

/// @param size   expected bytes; unsupported beyond kMaxPieceBytes.
/// @param is_cut returns the bytes before the end of the input, or before damage.
/// @return corrupt_data; unavailable, naming the package, where this build lacks the library.
[[nodiscard]] Result<UninitializedVector<std::byte>> unpack_chunk(Packing packing, std::span<const std::byte> packed,
                                                                  std::uint64_t size, bool is_cut);

}  // namespace saccade::internal::io_bags
