// SPDX-License-Identifier: Apache-2.0
#pragma once
// Kernels of the surface ray cast: marks of bricks that hold surface cells, and one ray per pixel. Thesis §2.2.1.

#include <cmath>
#include <cstdint>

#include "saccade/cuda/internal/device_map.hpp"
#include "saccade/cuda/internal/kernel.hpp"
#include "saccade/map/internal/cell.hpp"
#include "saccade/map/ray_walk.hpp"

namespace saccade::internal::cuda {

/// Where surface cells may be.
struct SurfaceMarks {
  std::uint8_t* bricks;  ///< one per brick of the table: whether it may hold a cell with an occupied corner
  std::uint8_t* blocks;  ///< one per block of bricks
};

struct MarkArguments {
  MapView map;
  SurfaceMarks marks;
};

struct SurfaceArguments {
  MapView map;
  SurfaceMarks marks;
  LatticePoint origin;    ///< in the lattice of the cells
  double per_cell[3][3];  ///< from camera directions to cells
  float R_camera_world[3][3];
  const double* ray_x;  ///< x of a ray by column
  const double* ray_y;  ///< y by row
  std::uint32_t width;
  std::uint32_t height;
  float min_range_m;
  float max_range_m;
  float* depths_m;
  float* normals;  ///< three per pixel
};

/// Marks bricks that may hold a surface cell: those with an occupied voxel in them or in a neighbour ahead.
struct MarkSurfaceBricks {
  using Arguments = MarkArguments;
  struct Shared {};
  static constexpr const char* kName{"saccade_mark_surface_bricks"};
  static constexpr unsigned kThreads{128};
  static constexpr unsigned kBlocksPerUnit{1};
  static constexpr int kPhases{1};

  template <int kPhase>
  static SACCADE_HD void run(const Arguments& a, Shared& /*shared*/, const Thread& thread) {
    const std::uint64_t at = std::uint64_t{thread.block} * kThreads + thread.index;
    if (at >= a.map.bricks.count()) return;
    const Index3 brick = a.map.bricks.index(at);
    bool occupied{false};
    for (int i = 0; i < 8; ++i) {
      const BrickEntry entry = a.map.entry(brick + Index3{i & 1, (i >> 1) & 1, (i >> 2) & 1});
      occupied = occupied || (entry.stored() && (entry.bits & BrickEntry::kOccupied) != 0);
    }
    a.marks.bricks[at] = occupied ? 1 : 0;
  }
};

/// Marks blocks with a marked brick.
struct MarkSurfaceBlocks {
  using Arguments = MarkArguments;
  struct Shared {};
  static constexpr const char* kName{"saccade_mark_surface_blocks"};
  static constexpr unsigned kThreads{128};
  static constexpr unsigned kBlocksPerUnit{1};
  static constexpr int kPhases{1};

  template <int kPhase>
  static SACCADE_HD void run(const Arguments& a, Shared& /*shared*/, const Thread& thread) {
    const std::uint64_t at = std::uint64_t{thread.block} * kThreads + thread.index;
    if (at >= a.map.blocks.count()) return;
    const Index3 first = a.map.blocks.index(at) * kBlockBrickEdge;
    std::uint8_t any{0};
    for (int i = 0; i < kBlockBrickEdge * kBlockBrickEdge * kBlockBrickEdge; ++i) {
      const Index3 brick = first + Index3{i & 3, (i >> 2) & 3, i >> 4};
      if (a.map.bricks.contains(brick)) any |= a.marks.bricks[a.map.bricks.at(brick)];
    }
    a.marks.blocks[at] = any;
  }
};

/// Reads v of a voxel; false where it is unknown.
[[nodiscard]] SACCADE_HD inline bool read_voxel(const MapView& map, const Index3& voxel, float& v) {
  const BrickEntry entry = map.entry(parent(voxel));
  if (!entry.stored()) {
    v = static_cast<float>(kSurfaceFree);
    return !entry.unknown();
  }
  const std::uint64_t at = std::uint64_t{entry.slot()} * kBrickVoxels + static_cast<std::uint64_t>(child_index(voxel));
  v = static_cast<float>(map.v[at]);
  return map.w[at] != 0;
}

/// Reads the cell with this lowest corner; false where a corner is unknown.
[[nodiscard]] SACCADE_HD inline bool read_cell(const MapView& map, const Index3& base, Cell& cell) {
  for (int i = 0; i < 8; ++i) {
    if (!read_voxel(map, base + Index3{i & 1, (i >> 1) & 1, (i >> 2) & 1}, cell.v[static_cast<std::size_t>(i)])) {
      return false;
    }
  }
  return true;
}

[[nodiscard]] SACCADE_HD inline bool has_surface(const Cell& cell) {
  bool inside{false};
  bool outside{false};
  for (int i = 0; i < 8; ++i) {
    inside = inside || cell.v[static_cast<std::size_t>(i)] <= 0.0F;
    outside = outside || cell.v[static_cast<std::size_t>(i)] > 0.0F;
  }
  return inside && outside;
}

/// Reads the cell with this lowest corner, in a brick with this entry; false where the surface does not cross it. Looks
/// at the brick's masks before any value.
[[nodiscard]] SACCADE_HD inline bool read_crossed_cell(const MapView& map, BrickEntry entry, const Index3& base,
                                                       Cell& cell) {
  constexpr int kLast{kBrickEdge - 1};
  const int x = base.x & kLast;
  const int y = base.y & kLast;
  const int z = base.z & kLast;
  if (x == kLast || y == kLast || z == kLast) return read_cell(map, base, cell) && has_surface(cell);
  if (!entry.stored()) return false;
  constexpr std::uint64_t kCorners{0x303};  // corners of a cell in a slice
  const std::uint64_t word = std::uint64_t{entry.slot()} * kBrickWords + static_cast<std::uint64_t>(z);
  const int shift = y * kBrickEdge + x;
  const std::uint64_t lower = map.occupied[word] >> shift & kCorners;
  const std::uint64_t upper = map.occupied[word + 1] >> shift & kCorners;
  if ((lower | upper) == 0 || (lower & upper) == kCorners) return false;
  if (((map.unknown[word] | map.unknown[word + 1]) >> shift & kCorners) != 0) return false;
  const std::int16_t* const v =
      map.v + std::uint64_t{entry.slot()} * kBrickVoxels + static_cast<std::uint64_t>(child_index(base));
  for (int i = 0; i < 8; ++i) {
    cell.v[static_cast<std::size_t>(i)] = static_cast<float>(v[(i & 1) + ((i & 2) << 2) + ((i & 4) << 4)]);
  }
  return true;
}

/// Derivative of v along an axis, per voxel: over two voxels, or across the cell where a neighbour is unknown.
[[nodiscard]] SACCADE_HD inline float slope(const MapView& map, const CellHit& hit, const Cell& cell, int axis) {
  const Index3 step{axis == 0 ? 1 : 0, axis == 1 ? 1 : 0, axis == 2 ? 1 : 0};
  float f[3]{hit.fraction[0], hit.fraction[1], hit.fraction[2]};
  Cell ahead;
  Cell behind;
  if (read_cell(map, hit.cell + step, ahead) && read_cell(map, hit.cell - step, behind)) {
    return 0.5F * (ahead.at(f[0], f[1], f[2]) - behind.at(f[0], f[1], f[2]));
  }
  const auto side = [&](float at) {
    return cell.at(axis == 0 ? at : f[0], axis == 1 ? at : f[1], axis == 2 ? at : f[2]);
  };
  return side(1.0F) - side(0.0F);
}

/// Casts one ray per pixel to the first crossing of the surface, as saccade::raycast does.
struct CastSurfaceRays {
  using Arguments = SurfaceArguments;
  struct Shared {};
  static constexpr const char* kName{"saccade_cast_surface_rays"};
  static constexpr std::uint32_t kColumns{8};
  static constexpr std::uint32_t kRows{16};
  static constexpr unsigned kThreads{kColumns * kRows};
  static constexpr unsigned kBlocksPerUnit{1};
  static constexpr int kPhases{1};

  template <int kPhase>
  static SACCADE_HD void run(const Arguments& a, Shared& /*shared*/, const Thread& thread) {
    const std::uint32_t tiles_across = (a.width + kColumns - 1) / kColumns;
    const std::uint32_t u = thread.block % tiles_across * kColumns + thread.index % kColumns;
    const std::uint32_t v = thread.block / tiles_across * kRows + thread.index / kColumns;
    if (u >= a.width || v >= a.height) return;
    const std::uint64_t pixel = std::uint64_t{v} * a.width + u;
    a.depths_m[pixel] = 0.0F;
    for (int axis = 0; axis < 3; ++axis) a.normals[3 * pixel + static_cast<std::uint64_t>(axis)] = 0.0F;
    float d[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double* m = a.per_cell[axis];
      d[axis] = static_cast<float>((m[0] * a.ray_x[u] + m[1] * a.ray_y[v]) + m[2]);
    }
    const LatticeRay ray = make_lattice_ray(a.origin, d[0], d[1], d[2]);
    CellHit hit;
    Cell cell;
    if (!meets_surface(a, ray, hit, cell) || !(hit.t > 0.0F) || hit.t < a.min_range_m) return;
    const float g[3]{slope(a.map, hit, cell, 0), slope(a.map, hit, cell, 1), slope(a.map, hit, cell, 2)};
    const float norm = std::sqrt(g[0] * g[0] + (g[1] * g[1] + g[2] * g[2]));
    if (!(norm > 0.0F)) return;
    a.depths_m[pixel] = hit.t;
    for (int axis = 0; axis < 3; ++axis) {
      const float* R = a.R_camera_world[axis];
      a.normals[3 * pixel + static_cast<std::uint64_t>(axis)] = (R[0] * g[0] + (R[1] * g[1] + R[2] * g[2])) / norm;
    }
  }

  /// Finds the first cell in which the ray crosses the surface; false where it crosses none, or from behind.
  [[nodiscard]] static SACCADE_HD bool meets_surface(const Arguments& a, const LatticeRay& ray, CellHit& hit,
                                                     Cell& cell) {
    const MapView& map = a.map;
    CellCrossing crossing{CellCrossing::none};
    const auto visit_cell = [&](BrickEntry entry, const Index3& index, const RaySpan& in_cell) {
      if (!read_crossed_cell(map, entry, index, cell)) return false;
      crossing = cross_cell(ray, index, cell, in_cell, hit);
      return crossing != CellCrossing::none;
    };
    const auto visit_brick = [&](const Index3& brick, const RaySpan& in_brick) {
      if (!map.bricks.contains(brick) || a.marks.bricks[map.bricks.at(brick)] == 0) return false;
      const BrickEntry entry = map.entry(brick);
      return walk_cells<kVoxelLevel>(ray, in_brick, [&](const Index3& index, const RaySpan& in_cell) {
        return visit_cell(entry, index, in_cell);
      });
    };
    const RaySpan span{kRayStart, after_depth(a.max_range_m)};
    const IndexBox table{map.bricks.lo * kBrickEdge,
                         (map.bricks.lo + Index3{static_cast<std::int32_t>(map.bricks.size_x),
                                                 static_cast<std::int32_t>(map.bricks.size_y),
                                                 static_cast<std::int32_t>(map.bricks.size_z)}) *
                             kBrickEdge};
    RaySpan inside = clip(ray, table);
    if (inside.empty()) return false;
    inside = inside.until(span.exit);
    if (inside.empty()) return false;
    walk_cells<kBlockLevel>(ray, inside, [&](const Index3& block, const RaySpan& in_block) {
      if (!map.blocks.contains(block) || a.marks.blocks[map.blocks.at(block)] == 0) return false;
      return walk_cells<kBrickLevel>(ray, in_block, visit_brick);
    });
    return crossing == CellCrossing::front;
  }
};

}  // namespace saccade::internal::cuda
