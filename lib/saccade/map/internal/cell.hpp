// SPDX-License-Identifier: Apache-2.0
#pragma once
// Cell: the TSDF between eight voxel centres. CellHit and cross_cell: the point where a ray meets the surface in it.

#include <array>
#include <cmath>
#include <cstdint>

#include "saccade/map/ray_math.hpp"

namespace saccade {

/// v at the corners of the cell between eight voxel centres, in units of 1/32767; corner i lies at
/// (i & 1, i >> 1 & 1, i >> 2 & 1). A cell is named by the voxel of its corner 0.
struct Cell {
  std::array<float, 8> v{};

  /// Interpolates trilinearly at coordinates within the cell, in [0, 1].
  [[nodiscard]] SACCADE_HD float at(float x, float y, float z) const {
    const float v00 = v[0] + (v[1] - v[0]) * x;
    const float v10 = v[2] + (v[3] - v[2]) * x;
    const float v01 = v[4] + (v[5] - v[4]) * x;
    const float v11 = v[6] + (v[7] - v[6]) * x;
    const float v0 = v00 + (v10 - v00) * y;
    const float v1 = v01 + (v11 - v01) * y;
    return v0 + (v1 - v0) * z;
  }
};

/// Point where a ray meets the surface: depth, cell, and position within the cell.
struct CellHit {
  float t{0.0F};
  Index3 cell;
  std::array<float, 3> fraction{};
};

enum class CellCrossing : std::uint8_t {
  none,
  front,   ///< from outside to inside: the surface is seen
  behind,  ///< from inside to outside: the surface is seen from behind
};

/// Returns the position of the ray within the cell at depth t, each coordinate clamped to [0, 1]. The ray is given in
/// the lattice of the cells, whose corners are voxel centres.
[[nodiscard]] SACCADE_HD inline std::array<float, 3> fraction_at(const LatticeRay& ray, const Index3& cell, float t) {
  const Index3 relative = cell - ray.origin;
  const std::array<float, 3> lo{static_cast<float>(relative.x), static_cast<float>(relative.y),
                                static_cast<float>(relative.z)};
  std::array<float, 3> fraction{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float f = (ray.o[axis] - lo[axis]) + t * ray.d[axis];
    fraction[axis] = f < 0.0F ? 0.0F : (f > 1.0F ? 1.0F : f);
  }
  return fraction;
}

/// Compares the interpolated TSDF where the ray enters and leaves the cell. For a front crossing, finds the zero by
/// regula falsi. A surface that the ray enters and leaves within one cell is thinner than the map resolves.
[[nodiscard]] SACCADE_HD inline CellCrossing cross_cell(const LatticeRay& ray, const Index3& index, const Cell& cell,
                                                        const RaySpan& span, CellHit& hit) {
  constexpr int kRootSteps{3};
  const auto value_at = [&](float t) {
    const std::array<float, 3> f = fraction_at(ray, index, t);
    return cell.at(f[0], f[1], f[2]);
  };
  float t0 = span.enter.t;
  float t1 = span.exit.t;
  float v0 = value_at(t0);
  float v1 = value_at(t1);
  if ((v0 > 0.0F) == (v1 > 0.0F)) return CellCrossing::none;
  if (v0 <= 0.0F) return CellCrossing::behind;
  float t = t0;
  for (int i = 0; i < kRootSteps; ++i) {
    t = t0 + (t1 - t0) * (v0 / (v0 - v1));
    const float v = value_at(t);
    if (v > 0.0F) {
      t0 = t;
      v0 = v;
    } else {
      t1 = t;
      v1 = v;
    }
  }
  hit = {t, index, fraction_at(ray, index, t)};
  return CellCrossing::front;
}

}  // namespace saccade
