// SPDX-License-Identifier: Apache-2.0
#pragma once
// LatticePoint, LatticeRay, RayEvent, RaySpan: where a ray crosses the planes of the voxel lattice, to the bit;
// position_at, entry_event, clip. Design §3 "Ray traversal is exact".

#include <cmath>
#include <cstdint>

#include "saccade/core/host_device.hpp"
#include "saccade/map/voxel_index.hpp"

namespace saccade {

/// Point on the lattice: its voxel, and its position in the voxel, a multiple of 2⁻¹⁶ in [0, 1).
struct LatticePoint {
  Index3 voxel;
  float fraction[3]{0.0F, 0.0F, 0.0F};
  [[nodiscard]] SACCADE_HD constexpr bool operator==(const LatticePoint& other) const {
    return voxel == other.voxel && fraction[0] == other.fraction[0] && fraction[1] == other.fraction[1] &&
           fraction[2] == other.fraction[2];
  }
};

/// Returns the lattice point nearest to (x, y, z), given in voxels (metres / voxel size). 2⁻¹⁶ voxel is 0.1 µm at 5.8
/// mm. Coordinates must stay below 2²⁹ voxels.
[[nodiscard]] SACCADE_HD inline LatticePoint lattice_point(double x, double y, double z) {
  constexpr double kSteps{65536.0};
  const double sx = std::floor(x * kSteps + 0.5);
  const double sy = std::floor(y * kSteps + 0.5);
  const double sz = std::floor(z * kSteps + 0.5);
  const double vx = std::floor(sx / kSteps);
  const double vy = std::floor(sy / kSteps);
  const double vz = std::floor(sz / kSteps);
  LatticePoint p;
  p.voxel = {static_cast<std::int32_t>(vx), static_cast<std::int32_t>(vy), static_cast<std::int32_t>(vz)};
  p.fraction[0] = static_cast<float>(sx / kSteps - vx);
  p.fraction[1] = static_cast<float>(sy / kSteps - vy);
  p.fraction[2] = static_cast<float>(sz / kSteps - vz);
  return p;
}

/// Returns the time at which a ray crosses a lattice plane: the one formula behind every walk. It is never accumulated,
/// and it is monotone in the plane. Walks over planes of voxels, bricks or sectors therefore give equal crossings.
template <class T>
[[nodiscard]] SACCADE_HD constexpr T crossing_time(T plane, T o, T inv) {
  return (plane - o) * inv;
}

/// Ray from a lattice point. t is depth: with d in voxels per metre of depth, t is in metres along camera +z. Lattice
/// coordinates inside are relative to the origin's voxel and must stay within ±2²³.
struct LatticeRay {
  Index3 origin;
  float o[3];
  float d[3];    ///< 0 where the ray never crosses a plane of that axis
  float inv[3];  ///< 1 / d; +∞ where d is 0

  /// Direction of travel along an axis; an axis that is never crossed counts as positive.
  [[nodiscard]] SACCADE_HD bool positive(int axis) const { return inv[axis] > 0.0F; }
  /// Crossing of the plane at relative coordinate `plane`; +∞ for planes ahead that are never crossed.
  [[nodiscard]] SACCADE_HD float crossing(int axis, std::int32_t plane) const {
    return crossing_time(static_cast<float>(plane), o[axis], inv[axis]);
  }
};

/// |d| below this counts as parallel to the axis' planes.
constexpr float kParallel{1e-20F};

/// dx, dy, dz: voxels per unit of t; at least one of them not parallel.
[[nodiscard]] SACCADE_HD inline LatticeRay make_lattice_ray(const LatticePoint& from, float dx, float dy, float dz) {
  const float d[3]{dx, dy, dz};
  LatticeRay ray{};
  ray.origin = from.voxel;
  for (int axis = 0; axis < 3; ++axis) {
    const bool parallel = std::fabs(d[axis]) < kParallel;
    ray.o[axis] = from.fraction[axis];
    ray.d[axis] = parallel ? 0.0F : d[axis];
    ray.inv[axis] = parallel ? HUGE_VALF : 1.0F / d[axis];
  }
  return ray;
}

/// Crossing of a lattice plane of an axis (0 x, 1 y, 2 z) at time t. Events are ordered by t, ties by axis. This order
/// decides which voxels a ray through an edge or a corner visits.
struct RayEvent {
  float t;
  int axis;
};
[[nodiscard]] SACCADE_HD constexpr bool before(const RayEvent& a, const RayEvent& b) {
  return a.t < b.t || (a.t == b.t && a.axis < b.axis);
}
/// Event before every crossing.
constexpr RayEvent kRayStart{0.0F, -1};
/// Returns the event after every crossing at t or earlier, so that voxels entered at exactly t are still visited.
[[nodiscard]] SACCADE_HD constexpr RayEvent after_depth(float t) { return {t, 3}; }

/// Part of a ray from the event `enter` (included) to the event `exit` (excluded).
struct RaySpan {
  RayEvent enter{kRayStart};
  RayEvent exit{kRayStart};
  [[nodiscard]] SACCADE_HD constexpr bool empty() const { return !before(enter, exit); }
  /// Returns the part of this span before `limit`.
  [[nodiscard]] SACCADE_HD constexpr RaySpan until(const RayEvent& limit) const {
    return {enter, before(limit, exit) ? limit : exit};
  }
};

namespace ray_detail {
constexpr float kLargestCoordinate{8388608.0F};
[[nodiscard]] SACCADE_HD inline std::int32_t estimate(const LatticeRay& ray, int axis, float t) {
  const float x = ray.o[axis] + t * ray.d[axis];
  const float clamped = x < -kLargestCoordinate ? -kLargestCoordinate : x > kLargestCoordinate ? kLargestCoordinate : x;
  const auto truncated = static_cast<std::int32_t>(clamped);
  return static_cast<float>(truncated) > clamped ? truncated - 1 : truncated;
}
}  // namespace ray_detail

/// Returns the relative voxel coordinate along `axis` after every crossing up to and including `event`. It is estimated
/// as o + t·d and then settled by the crossings themselves.
[[nodiscard]] SACCADE_HD inline std::int32_t position_at(const LatticeRay& ray, int axis, const RayEvent& event) {
  std::int32_t p = ray_detail::estimate(ray, axis, event.t);
  if (ray.positive(axis)) {
    if (p < 0) p = 0;
    while (p > 0 && before(event, {ray.crossing(axis, p), axis})) --p;
    while (!before(event, {ray.crossing(axis, p + 1), axis})) ++p;
  } else {
    if (p > 0) p = 0;
    while (p < 0 && before(event, {ray.crossing(axis, p + 1), axis})) ++p;
    while (!before(event, {ray.crossing(axis, p), axis})) --p;
  }
  return p;
}

/// Returns the voxel of the ray after every crossing up to and including `event`.
[[nodiscard]] SACCADE_HD inline Index3 voxel_at_event(const LatticeRay& ray, const RayEvent& event) {
  return ray.origin + Index3{position_at(ray, 0, event), position_at(ray, 1, event), position_at(ray, 2, event)};
}

/// Returns the event at which the ray enters a voxel on it; kRayStart for the origin's own voxel.
[[nodiscard]] SACCADE_HD inline RayEvent entry_event(const LatticeRay& ray, const Index3& voxel) {
  const std::int32_t p[3]{voxel.x - ray.origin.x, voxel.y - ray.origin.y, voxel.z - ray.origin.z};
  RayEvent latest = kRayStart;
  for (int axis = 0; axis < 3; ++axis) {
    if (p[axis] == 0) continue;
    const RayEvent crossed{ray.crossing(axis, ray.positive(axis) ? p[axis] : p[axis] + 1), axis};
    if (before(latest, crossed)) latest = crossed;
  }
  return latest;
}

/// Returns the part of the ray within a box of voxels (not empty). It visits exactly those voxels of the full walk that
/// lie in the box.
[[nodiscard]] SACCADE_HD inline RaySpan clip(const LatticeRay& ray, const IndexBox& box) {
  const std::int32_t lo[3]{box.lo.x - ray.origin.x, box.lo.y - ray.origin.y, box.lo.z - ray.origin.z};
  const std::int32_t hi[3]{box.hi.x - ray.origin.x, box.hi.y - ray.origin.y, box.hi.z - ray.origin.z};
  RayEvent enter = kRayStart;
  RayEvent exit{HUGE_VALF, 3};
  for (int axis = 0; axis < 3; ++axis) {
    const bool positive = ray.positive(axis);
    if (positive ? hi[axis] <= 0 : lo[axis] > 0) return {};  // the box lies behind
    if (positive ? lo[axis] > 0 : hi[axis] <= 0) {
      const RayEvent crossed{ray.crossing(axis, positive ? lo[axis] : hi[axis]), axis};
      if (before(enter, crossed)) enter = crossed;
    }
    const RayEvent left{ray.crossing(axis, positive ? hi[axis] : lo[axis]), axis};
    if (before(left, exit)) exit = left;
  }
  return {enter, exit};
}

}  // namespace saccade
