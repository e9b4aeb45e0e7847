// SPDX-License-Identifier: Apache-2.0
#pragma once
// write_ternary_points: occupied and frontier voxels as a PLY cloud; write_ternary_volume: a dense NPY volume;
// frontier_voxels.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "saccade/core/region.hpp"
#include "saccade/core/result.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade {

/// Values of the states in exported files (eq. 2.11): 0 unknown, 1 empty, 2 occupied, as VoxelState.
struct TernaryPointsConfig {
  std::optional<Box> box;  ///< limits the voxels by their centres; none: the whole map
  bool occupied{true};
  bool frontier{true};  ///< unknown voxels with an empty voxel at one of their six faces, inside the workspace
};

struct TernaryPoints {
  std::size_t occupied{0};
  std::size_t frontier{0};
};

/// Binary PLY with one vertex per voxel: x y z (its centre, world, metres), red green blue (the fused colour, grey
/// where there is none, black for unknown), state. Order by sector, brick, voxel. Written atomically.
/// @return invalid_argument for an empty box, io_failure. O(bricks), two passes; memory does not grow with the map.
[[nodiscard]] Result<TernaryPoints> write_ternary_points(const TsdfSnapshot& map, const std::filesystem::path& path,
                                                         const TernaryPointsConfig& config = {});

/// Returns the centres of the unknown voxels with an empty voxel at one of their six faces, inside the workspace, in
/// the order of write_ternary_points. Empty where there are more than `most`. O(bricks).
[[nodiscard]] std::vector<Eigen::Vector3f> frontier_voxels(const TsdfSnapshot& map, std::size_t most);

struct TernaryVolumeConfig {
  std::optional<Box> box;  ///< limits the voxels by their centres; none: the smallest box around all known bricks
  std::uint64_t max_bytes{std::uint64_t{4} << 30U};
};

/// Writes one byte per voxel (z, y, x) as a NumPy file, and `path` with the extension .json: shape, origin_m (centre of
/// the first voxel), voxel_size_m, the meaning of the values. Both atomically.
/// @return the voxels written; invalid_argument for an empty box or map, and for a box of more than max_bytes, with its
/// size; io_failure. O(voxels); one slice is held in memory.
[[nodiscard]] Result<IndexBox> write_ternary_volume(const TsdfSnapshot& map, const std::filesystem::path& path,
                                                    const TernaryVolumeConfig& config = {});

}  // namespace saccade
