// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/ray_beam.hpp"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

// Slack far above the error of float32 crossings (a few 2⁻²⁴ of the distance), and far below a voxel.
constexpr float kBeamSlack_vox{0.01F};
constexpr float kBeamSlackRate{2e-6F};
constexpr float kSteepest{10.0F};  // largest slope; 1.4 where the major axis is that of the ray

struct Direction {
  float d[3];
};
Direction direction(const CastWindow& window, int column, int row) {
  const float a = window.a[static_cast<std::size_t>(column)];
  const float b = window.b[static_cast<std::size_t>(row)];
  const SensorRays& rays = window.rays;
  return {{rays.x[0] * a + (rays.y[0] * b + rays.z[0]), rays.x[1] * a + (rays.y[1] * b + rays.z[1]),
           rays.x[2] * a + (rays.y[2] * b + rays.z[2])}};
}

}  // namespace

int major_axis(const CastWindow& window, const Tile& tile) {
  const Direction middle =
      direction(window, (tile.column_begin + tile.column_end) / 2, (tile.row_begin + tile.row_end) / 2);
  int major{0};
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(middle.d[axis]) > std::abs(middle.d[major])) major = axis;
  }
  return major;
}

RayBeam::RayBeam(const CastWindow& window, const Tile& tile)
    : major_{tile.major}, origin_{window.rays.origin.voxel.x, window.rays.origin.voxel.y, window.rays.origin.voxel.z} {
  const float* const o = window.rays.origin.fraction;
  minor_[0].axis = major_ == 0 ? 1 : 0;
  minor_[1].axis = major_ == 2 ? 1 : 2;
  // Directions are affine in the pixel, so their ratios are extreme at the corners of the tile.
  const Direction corners[4]{
      direction(window, tile.column_begin, tile.row_begin), direction(window, tile.column_end - 1, tile.row_begin),
      direction(window, tile.column_begin, tile.row_end - 1), direction(window, tile.column_end - 1, tile.row_end - 1)};
  float inverse[4];
  positive_ = corners[0].d[major_] > 0.0F;
  slowest_ = fastest_ = std::abs(corners[0].d[major_]);
  for (int i = 0; i < 4; ++i) {
    const float speed = std::abs(corners[i].d[major_]);
    slowest_ = std::min(slowest_, speed);
    fastest_ = std::max(fastest_, speed);
    inverse[i] = 1.0F / speed;
  }
  float steepest{0.0F};
  for (MinorAxisBounds& minor : minor_) {
    minor.start = o[minor.axis];
    minor.slope_lo = minor.slope_hi = corners[0].d[minor.axis] * inverse[0];
    for (int i = 1; i < 4; ++i) {
      const float slope = corners[i].d[minor.axis] * inverse[i];
      minor.slope_lo = std::min(minor.slope_lo, slope);
      minor.slope_hi = std::max(minor.slope_hi, slope);
    }
    steepest = std::max({steepest, -minor.slope_lo, minor.slope_hi});
  }
  for (const Direction& corner : corners) one_way_ = one_way_ && (corner.d[major_] > 0.0F) == positive_;
  one_way_ = one_way_ && slowest_ > 0.0F && steepest <= kSteepest;
  slack_ = kBeamSlack_vox;
  slack_rate_ = kBeamSlackRate * (1.0F + steepest);
  const int in_brick = origin_[major_] & (kBrickEdge - 1);
  skipped_ = positive_ ? in_brick : kBrickEdge - 1 - in_brick;
  first_ = positive_ ? 1.0F - o[major_] : o[major_];
}

int RayBeam::last_slab(const IndexBox& voxels) const {
  const std::int32_t lo[3]{voxels.lo.x, voxels.lo.y, voxels.lo.z};
  const std::int32_t hi[3]{voxels.hi.x, voxels.hi.y, voxels.hi.z};
  return positive_ ? hi[major_] - 1 - origin_[major_] : origin_[major_] - lo[major_];
}

}  // namespace saccade
