// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfaceTiles: the bricks of the mapped surface that each tile of an image can see. sectors_cast_through: what a ray
// cast reads.

#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/map/tsdf_grid.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// Returns the sectors of the grid that a ray cast of this view may read, in z-y-x order: those that may be in the
/// image, and their neighbours. O(sectors).
[[nodiscard]] std::vector<Index3> sectors_cast_through(const TsdfGrid& grid, const PinholeCamera& camera,
                                                       const Pose& T_world_camera, double voxel_size_m);

/// Lists, for each tile of 8×8 pixels, all bricks that may hold a surface cell crossed by a ray of the tile, and some
/// more. A cell lies between eight voxel centres and is named by its lowest corner, whose brick it belongs to. O(bricks
/// with occupied voxels + entries).
class SurfaceTiles {
 public:
  static constexpr int kTilePx{8};
  static constexpr int kBlockPx{4};  ///< a tile has 2×2 blocks
  static constexpr std::size_t kBlockRays{std::size_t{kBlockPx} * kBlockPx};

  /// A brick in the list of a tile.
  struct Entry {
    float nearest_m{0.0F};   ///< smallest depth of its cells, along the camera's z
    std::uint32_t brick{0};  ///< index into bricks()
    std::uint8_t blocks{0};  ///< bit x + 2 y: block (x, y) of the tile may see it
  };

  /// Lists the bricks for each tile. `sectors` covers the grid.
  SurfaceTiles(const TsdfGrid& grid, const SectorTable& sectors, const PinholeCamera& camera,
               const Pose& T_world_camera, double voxel_size_m, const Executor& executor);

  [[nodiscard]] int width() const { return width_; }    ///< tiles
  [[nodiscard]] int height() const { return height_; }  ///< tiles
  /// A brick with surface cells that may be in the image.
  struct Brick {
    Index3 index;
    Mask512 cells;  ///< crossed_cells
    IndexBox box;   ///< box around the cells, voxels within the brick
  };
  [[nodiscard]] const std::vector<Brick>& bricks() const { return bricks_; }
  /// Returns the entries of a tile in no particular order.
  [[nodiscard]] std::span<const Entry> entries(int tile_u, int tile_v) const {
    const auto tile =
        static_cast<std::size_t>(tile_v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(tile_u);
    return {entries_.data() + first_entry_[tile], entries_.data() + first_entry_[tile + 1]};
  }

 private:
  int width_;
  int height_;
  std::vector<Brick> bricks_;
  std::vector<std::size_t> first_entry_;  // per tile, and the end
  std::vector<Entry> entries_;
};

}  // namespace saccade
