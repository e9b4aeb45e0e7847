// SPDX-License-Identifier: Apache-2.0
#pragma once
// save_map, load_map: maps in .sacmap files. encode_map, decode_map: such files in memory.

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade {

/// Writes the map with its configuration: a header with a checksum, then its sectors in z-y-x order, each compressed by
/// zstd, each brick with its own CRC-32 (docs/reference/formats.md specifies the bytes). Equal maps give equal bytes
/// for every thread count. `path` appears only when complete.
/// @return io_failure naming the path; invalid_argument for a map that load_map would reject (a bad configuration, a
/// brick that is not canonical, a sector farther than 2^20 from the origin).
/// Of a paged map, sectors are read from its store, a few at a time; errors: those of the store.
/// O(bricks); a few compressed sectors are held in memory at a time.
[[nodiscard]] Status save_map(const TsdfSnapshot& map, const std::filesystem::path& path,
                              const Executor& executor = {});

/// Reads a file of save_map: the grid is equal, and saving it again gives equal bytes.
/// @return not_found, io_failure; unsupported for a newer version of the format; corrupt_data for any other file, and
/// for a truncated or damaged one, with the byte, sector and brick. Memory is bounded by the actual content, whatever
/// sizes the file claims.
[[nodiscard]] Result<TsdfSnapshot> load_map(const std::filesystem::path& path, const Executor& executor = {});

/// Returns the bytes of such a file. Answers invalid_argument as save_map.
[[nodiscard]] Result<std::vector<std::byte>> encode_map(const TsdfSnapshot& map, const Executor& executor = {});
/// Errors as in load_map.
[[nodiscard]] Result<TsdfSnapshot> decode_map(std::span<const std::byte> file, const Executor& executor = {});

}  // namespace saccade
