// SPDX-License-Identifier: Apache-2.0
#pragma once
// TileDepths: between which depths the rays of each image tile can meet the surface at all.

#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/map/surface_table.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// Conservative depth interval along camera z per tile of 8×8 pixels, from projecting every brick with surface cells:
/// outside it no ray of the tile crosses a surface cell. O(bricks with surface).
class TileDepths {
 public:
  static constexpr int kTilePx{8};
  struct Interval {
    float nearest_m{0.0F};
    float farthest_m{-1.0F};  ///< below nearest_m: nothing to meet
  };

  TileDepths(const SurfaceTable& surface, const PinholeCamera& camera, const Pose& T_world_camera, double voxel_size_m);

  [[nodiscard]] const Interval& at_pixel(int u, int v) const {
    return tiles_[static_cast<std::size_t>(v / kTilePx) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(u / kTilePx)];
  }

 private:
  void widen(int tile_u0, int tile_v0, int tile_u1, int tile_v1, const Interval& interval);

  int width_;
  int height_;
  std::vector<Interval> tiles_;
};

}  // namespace saccade
