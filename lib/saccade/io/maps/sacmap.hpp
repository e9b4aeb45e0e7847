// SPDX-License-Identifier: Apache-2.0
#pragma once
// save_map, load_map: maps in .sacmap files; encode_map, decode_map: the same in memory.

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade {

/// Writes the map with its configuration: a header with a checksum, then its sectors in z-y-x order, each compressed by
/// zstd, each brick with its own CRC-32 (docs/formats.md has the bytes). Equal maps give equal bytes, whatever the
/// thread count. Nothing is left under `path` unless it is complete.
/// @return io_failure naming the path; invalid_argument for a map that load_map would refuse (a bad configuration, a
///         brick that is not canonical, a sector farther than 2^20 from the origin).
/// O(bricks); a few compressed sectors are held in memory at a time.
[[nodiscard]] Status save_map(const TsdfSnapshot& map, const std::filesystem::path& path,
                              const Executor& executor = {});

/// Reads what save_map wrote: an equal grid, and saving it again gives the same bytes.
/// @return not_found, io_failure; unsupported for a newer version of the format; corrupt_data for anything else that is
///         not such a file, cut short or damaged, saying at which byte and in which sector and brick.
/// Memory is bounded by what the file really holds, whatever sizes it claims.
[[nodiscard]] Result<TsdfSnapshot> load_map(const std::filesystem::path& path, const Executor& executor = {});

/// The bytes of such a file. invalid_argument as in save_map.
[[nodiscard]] Result<std::vector<std::byte>> encode_map(const TsdfSnapshot& map, const Executor& executor = {});
/// Errors as in load_map.
[[nodiscard]] Result<TsdfSnapshot> decode_map(std::span<const std::byte> file, const Executor& executor = {});

}  // namespace saccade
