// SPDX-License-Identifier: Apache-2.0
#pragma once
// unpack_chunk: bytes that bz2, lz4 or zstd packed.

#include <cstdint>
#include <span>
#include <string_view>

#include "saccade/core/result.hpp"
#include "saccade/core/unset_vector.hpp"

namespace saccade::internal::io_bags {

enum class Packing : std::uint8_t { none, bz2, lz4, zstd, other };
/// "" and "none", "bz2", "lz4", "zstd".
[[nodiscard]] Packing packing_of(std::string_view name);

/// @param size   bytes that must come out; unsupported beyond kMaxPieceBytes.
/// @param is_cut what comes out before the end of the input, or before damage, is returned.
/// @return corrupt_data; unavailable, naming the package, where this build has no such library.
[[nodiscard]] Result<UnsetVector<std::byte>> unpack_chunk(Packing packing, std::span<const std::byte> packed,
                                                          std::uint64_t size, bool is_cut);

}  // namespace saccade::internal::io_bags
