// SPDX-License-Identifier: Apache-2.0
#pragma once
// Integer coordinates of voxels, bricks (8³ voxels) and sectors (8³ bricks), and how they nest.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "saccade/core/host_device.hpp"

namespace saccade {

constexpr int kBrickEdge{8};                                           ///< voxels along an edge of a brick
constexpr int kBrickVoxels{kBrickEdge * kBrickEdge * kBrickEdge};      ///< 512
constexpr int kSectorEdge{8};                                          ///< bricks along an edge of a sector
constexpr int kSectorBricks{kSectorEdge * kSectorEdge * kSectorEdge};  ///< 512
constexpr int kSectorVoxelEdge{kBrickEdge * kSectorEdge};              ///< 64 voxels along an edge of a sector

/// Integer lattice coordinates of voxels, bricks or sectors; variable names say which. Voxel (x, y, z) covers [x,
/// x+1)·e × … where e is the voxel size; its centre is at +0.5.
struct Index3 {
  std::int32_t x{0};
  std::int32_t y{0};
  std::int32_t z{0};
  [[nodiscard]] SACCADE_HD constexpr bool operator==(const Index3&) const = default;
  [[nodiscard]] SACCADE_HD constexpr Index3 operator+(const Index3& o) const { return {x + o.x, y + o.y, z + o.z}; }
  [[nodiscard]] SACCADE_HD constexpr Index3 operator-(const Index3& o) const { return {x - o.x, y - o.y, z - o.z}; }
  [[nodiscard]] SACCADE_HD constexpr Index3 operator*(std::int32_t s) const { return {x * s, y * s, z * s}; }
  /// Returns the smaller of each coordinate.
  [[nodiscard]] constexpr Index3 cwise_min(const Index3& o) const {
    return {std::min(x, o.x), std::min(y, o.y), std::min(z, o.z)};
  }
  /// Returns the larger of each coordinate.
  [[nodiscard]] constexpr Index3 cwise_max(const Index3& o) const {
    return {std::max(x, o.x), std::max(y, o.y), std::max(z, o.z)};
  }
};

/// Order of files and of every deterministic walk: z slowest, x fastest.
[[nodiscard]] constexpr bool zyx_less(const Index3& a, const Index3& b) {
  if (a.z != b.z) return a.z < b.z;
  if (a.y != b.y) return a.y < b.y;
  return a.x < b.x;
}

/// Floor division by 8 (voxel → brick, brick → sector); arithmetic shift rounds towards −∞.
[[nodiscard]] SACCADE_HD constexpr Index3 parent(const Index3& i) { return {i.x >> 3, i.y >> 3, i.z >> 3}; }
/// Linear index of a child within its parent, x fastest: (z·8 + y)·8 + x in [0, 512).
[[nodiscard]] SACCADE_HD constexpr int child_index(const Index3& i) {
  return ((i.z & 7) << 6) | ((i.y & 7) << 3) | (i.x & 7);
}
/// Inverse of child_index.
[[nodiscard]] SACCADE_HD constexpr Index3 child_offset(int index) {
  return {index & 7, (index >> 3) & 7, (index >> 6) & 7};
}

/// Voxel that contains the point. |p| / e must stay below 2³⁰.
[[nodiscard]] inline Index3 voxel_at(const Eigen::Vector3d& p_world, double voxel_size_m) {
  return {static_cast<std::int32_t>(std::floor(p_world.x() / voxel_size_m)),
          static_cast<std::int32_t>(std::floor(p_world.y() / voxel_size_m)),
          static_cast<std::int32_t>(std::floor(p_world.z() / voxel_size_m))};
}
/// Centre of a voxel in metres.
[[nodiscard]] inline Eigen::Vector3d voxel_center(const Index3& voxel, double voxel_size_m) {
  return {(voxel.x + 0.5) * voxel_size_m, (voxel.y + 0.5) * voxel_size_m, (voxel.z + 0.5) * voxel_size_m};
}

/// Half-open integer box [lo, hi).
struct IndexBox {
  Index3 lo;
  Index3 hi;
  [[nodiscard]] SACCADE_HD constexpr bool contains(const Index3& i) const {
    return i.x >= lo.x && i.x < hi.x && i.y >= lo.y && i.y < hi.y && i.z >= lo.z && i.z < hi.z;
  }
  [[nodiscard]] SACCADE_HD constexpr bool empty() const { return lo.x >= hi.x || lo.y >= hi.y || lo.z >= hi.z; }
  [[nodiscard]] constexpr bool operator==(const IndexBox&) const = default;

  /// Returns the box of `edge` indices along each axis from `lo` on.
  [[nodiscard]] static constexpr IndexBox cube(const Index3& lo, std::int32_t edge) {
    return {lo, lo + Index3{edge, edge, edge}};
  }
  [[nodiscard]] constexpr Index3 size() const { return hi - lo; }
  /// Returns the number of indices in a box that is not empty; never overflows.
  [[nodiscard]] constexpr double count() const {
    return (static_cast<double>(hi.x) - lo.x) * (static_cast<double>(hi.y) - lo.y) * (static_cast<double>(hi.z) - lo.z);
  }
  /// Returns the intersection with another box; empty where they do not overlap.
  [[nodiscard]] constexpr IndexBox intersection(const IndexBox& o) const {
    return {lo.cwise_max(o.lo), hi.cwise_min(o.hi)};
  }
  [[nodiscard]] constexpr bool overlaps(const IndexBox& o) const { return !intersection(o).empty(); }
  [[nodiscard]] constexpr bool contains(const IndexBox& o) const { return o.empty() || intersection(o) == o; }
  /// Returns the smallest box around both; an empty box adds nothing.
  [[nodiscard]] constexpr IndexBox hull(const IndexBox& o) const {
    if (empty()) return o;
    return o.empty() ? *this : IndexBox{lo.cwise_min(o.lo), hi.cwise_max(o.hi)};
  }
  /// Returns the box grown by `by` indices on every side.
  [[nodiscard]] constexpr IndexBox grown(std::int32_t by) const {
    return {lo - Index3{by, by, by}, hi + Index3{by, by, by}};
  }
  /// Returns the indices with z = lo.z + i.
  [[nodiscard]] constexpr IndexBox layer(std::size_t i) const {
    const std::int32_t z = lo.z + static_cast<std::int32_t>(i);
    return {{lo.x, lo.y, z}, {hi.x, hi.y, z + 1}};
  }
  /// Calls visit(index) for every index, z slowest, x fastest.
  template <class Visit>
  constexpr void for_each(const Visit& visit) const {
    for (std::int32_t z = lo.z; z < hi.z; ++z) {
      for (std::int32_t y = lo.y; y < hi.y; ++y) {
        for (std::int32_t x = lo.x; x < hi.x; ++x) visit(Index3{x, y, z});
      }
    }
  }
};

/// Returns the bricks that hold the voxels of a box, or the sectors that hold its bricks. Expects a box that is not
/// empty.
[[nodiscard]] constexpr IndexBox parents(const IndexBox& box) {
  return {parent(box.lo), parent(box.hi - Index3{1, 1, 1}) + Index3{1, 1, 1}};
}

struct Index3Hash {
  [[nodiscard]] std::size_t operator()(const Index3& i) const noexcept {
    // Three odd multipliers, then a finaliser, so that neighbouring indices spread over the table.
    std::uint64_t h = static_cast<std::uint32_t>(i.x) * 0x9E3779B97F4A7C15ULL;
    h ^= static_cast<std::uint32_t>(i.y) * 0xC2B2AE3D27D4EB4FULL;
    h ^= static_cast<std::uint32_t>(i.z) * 0x165667B19E3779F9ULL;
    h ^= h >> 29;
    h *= 0xBF58476D1CE4E5B9ULL;
    return static_cast<std::size_t>(h ^ (h >> 32));
  }
};

}  // namespace saccade
