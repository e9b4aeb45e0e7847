// SPDX-License-Identifier: Apache-2.0
#pragma once
// cast_in_brick: casts the rays of one image tile at the surface cells of one brick, many rays at a time.

#include <array>
#include <cmath>
#include <cstdint>

#include "saccade/map/brick.hpp"
#include "saccade/map/internal/surface_tiles.hpp"
#include "saccade/map/voxel_block.hpp"

namespace saccade::tile_cast {

constexpr int kTileRays{64};

/// Rays of a tile from one origin, as in LatticeRay.
struct TileRays {
  alignas(64) std::array<std::array<float, kTileRays>, 3> d;
  alignas(64) std::array<std::array<float, kTileRays>, 3> inv;
  std::array<float, 3> o;  ///< position of the origin within its voxel
  float farthest_m;        ///< no cell is entered beyond this depth
};

/// Ends of the tile's rays so far.
struct TileHits {
  alignas(64) std::array<float, kTileRays> brick_t;  ///< the event at which the ray entered the box of the brick …
  alignas(64) std::array<std::int32_t, kTileRays> brick_axis;  ///< … in which it ended; +∞, 3 where it did not end
  alignas(64) std::array<float, kTileRays> t;                  ///< depth of the surface; 0: none, or seen from behind
  alignas(64) std::array<std::array<float, kTileRays>, 3> fraction;  ///< position in the cell
  alignas(64) std::array<std::array<float, kTileRays>, 3> gradient;  ///< ∇v, per voxel
  alignas(64) std::array<std::int32_t, kTileRays> cell;              ///< the cell, as child_index within the brick
  alignas(64) std::array<std::uint32_t, kTileRays> brick;            ///< the entry given to cast_in_brick

  void clear() {
    brick_t.fill(HUGE_VALF);
    brick_axis.fill(3);
    t.fill(0.0F);
  }
};

/// Surface of a brick: the cells it crosses, and the voxels around.
struct SurfaceBrick {
  Mask512 cells;
  IndexBox box;  ///< box around the cells, within the brick
  VoxelBlock voxels;
};

/// Continues every ray of the tile through the brick. Of several ends, a ray keeps that in the brick it enters first.
/// Visits the cells of walk_cells, and agrees to the bit with cross_cell and gradient_at on the scalar path. `lo`: the
/// brick's first voxel relative to the rays' origin; `entry`: the brick in the tile's list. Returns the largest
/// brick_t: bricks that begin beyond it change nothing any more.
float cast_in_brick(const TileRays& rays, const Index3& lo, const SurfaceBrick& surface,
                    const SurfaceTiles::Entry& entry, TileHits& hits);

}  // namespace saccade::tile_cast
