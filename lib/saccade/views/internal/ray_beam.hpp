// SPDX-License-Identifier: Apache-2.0
#pragma once
// RayBeam: bounds of the rays of a tile of pixels, in slabs of voxels or bricks along one axis.

#include "saccade/views/internal/cast_window.hpp"

namespace saccade {

/// Rectangle of rays of a window: columns and rows [begin, end).
struct Tile {
  int column_begin;
  int column_end;
  int row_begin;
  int row_end;
  int major;  ///< axis of the slabs: that of the rays' largest component
  int slab;   ///< no ray meets anything before this slab of voxels

  [[nodiscard]] int columns() const { return column_end - column_begin; }
  [[nodiscard]] int rows() const { return row_end - row_begin; }
};

/// Returns the axis along which the middle ray of a rectangle of a window advances fastest.
[[nodiscard]] int major_axis(const CastWindow& window, const Tile& tile);

/// Bounds of the rays of a tile. Slab n is the plane of voxels (or bricks) n steps from the camera's along the major
/// axis. Within it, every ray of the tile lies in the box given, including the rounding of the exact walk.
class RayBeam {
 public:
  RayBeam(const CastWindow& window, const Tile& tile);

  /// Tells whether all rays advance along the major axis, and not too slowly. The bounds hold only then; they fail for
  /// wide tiles of a sensor with few pixels.
  [[nodiscard]] bool one_way() const { return one_way_; }

  /// Distances along the major axis, in voxels, at which slab n of voxels begins and ends.
  [[nodiscard]] float near(int n) const { return n == 0 ? 0.0F : first_ + static_cast<float>(n - 1); }
  [[nodiscard]] float far(int n) const { return first_ + static_cast<float>(n); }
  /// Smallest and largest |d| of the rays along the major axis, in voxels per metre of depth.
  [[nodiscard]] float slowest() const { return slowest_; }
  [[nodiscard]] float fastest() const { return fastest_; }

  /// Slab of bricks that holds a slab of voxels, and first slab of voxels in a slab of bricks.
  [[nodiscard]] int brick_slab(int n) const { return (n + skipped_) >> 3; }
  [[nodiscard]] int first_voxel_slab(int bricks) const { return bricks == 0 ? 0 : bricks * kBrickEdge - skipped_; }
  /// Returns the last slab of voxels that cuts the box; negative when the box lies behind.
  [[nodiscard]] int last_slab(const IndexBox& voxels) const;

  /// Voxels that rays may touch in the slabs [n, end) of voxels, as lowest and highest index.
  struct Voxels {
    Index3 lo;
    Index3 hi;
  };
  [[nodiscard]] Voxels voxels(int n, int end) const {
    const float from = near(n);
    const float to = far(end - 1);
    const float slack = slack_ + slack_rate_ * to;
    std::int32_t lo[3];
    std::int32_t hi[3];
    const std::int32_t at = origin_[major_];
    lo[major_] = positive_ ? at + n : at - (end - 1);
    hi[major_] = positive_ ? at + end - 1 : at - n;
    for (int k = 0; k < 2; ++k) {
      const MinorAxisBounds& minor = minor_[k];
      const float least = minor.start + minor.slope_lo * (minor.slope_lo < 0.0F ? to : from) - slack;
      const float most = minor.start + minor.slope_hi * (minor.slope_hi < 0.0F ? from : to) + slack;
      lo[minor.axis] = origin_[minor.axis] + floor_to_int(least);
      hi[minor.axis] = origin_[minor.axis] + floor_to_int(most);
    }
    return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
  }

 private:
  struct MinorAxisBounds {
    int axis;
    float start;     // the camera in its voxel
    float slope_lo;  // per unit of distance along the major axis
    float slope_hi;
  };
  static std::int32_t floor_to_int(float x) {
    const auto truncated = static_cast<std::int32_t>(x);
    return truncated - (static_cast<float>(truncated) > x ? 1 : 0);
  }

  int major_;
  bool positive_;
  bool one_way_{true};
  std::int32_t origin_[3];
  int skipped_;  // voxels of the camera's brick that lie behind its voxel
  float first_;  // distance at which the camera's own voxel ends
  float slowest_;
  float fastest_;
  float slack_;
  float slack_rate_;
  MinorAxisBounds minor_[2];
};

}  // namespace saccade
