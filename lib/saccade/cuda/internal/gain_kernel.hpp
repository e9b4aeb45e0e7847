// SPDX-License-Identifier: Apache-2.0
#pragma once
// CountScoringRays: expected information gain on the device. Thesis §2.2.3, eq. (2.6), (2.10), (2.11), Algorithm 2.

#include <cmath>
#include <cstdint>

#include "saccade/cuda/internal/device_map.hpp"
#include "saccade/cuda/internal/kernel.hpp"
#include "saccade/map/ray_walk.hpp"

namespace saccade::internal::cuda {

/// Region without std::variant. Contains what saccade::contains does, to the bit.
struct RegionShape {
  enum class Kind : std::uint32_t { sphere, box };
  Kind kind{Kind::sphere};
  double a[3]{};  ///< centre, or minimum
  double b[3]{};  ///< radius first, or maximum

  [[nodiscard]] SACCADE_HD bool contains(const Index3& voxel, double voxel_size_m) const {
    const double p[3]{(voxel.x + 0.5) * voxel_size_m, (voxel.y + 0.5) * voxel_size_m, (voxel.z + 0.5) * voxel_size_m};
    if (kind == Kind::sphere) {
      const double x = a[0] - p[0];
      const double y = a[1] - p[1];
      const double z = a[2] - p[2];
      return __builtin_sqrt((x * x + y * y) + z * z) < b[0];
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (!(p[axis] >= a[axis] && p[axis] < b[axis])) return false;
    }
    return true;
  }
};

/// Window of the image of one pose, or of poses that share their rays.
struct GainWindow {
  LatticePoint origin;
  float x[3];  ///< axes as in SensorRays
  float y[3];
  float z[3];
  float to_center[3];     ///< from the origin to the centre of a sphere, in voxels
  std::uint32_t first_a;  ///< index of the first column's coordinate in GainArguments::coordinates
  std::uint32_t first_b;  ///< likewise for the rows
  std::uint32_t columns;
  std::uint32_t rows;
  std::uint32_t first_tile;  ///< number of the first tile, counted over all windows
};

constexpr std::uint32_t kTileColumns{8};
constexpr std::uint32_t kTileRows{8};
constexpr std::uint32_t kTilesPerHint{64};  ///< tiles for which the host names one window to look from

struct GainArguments {
  MapView map;
  RegionShape region;
  float radius_vox;        ///< a ray that passes a sphere's centre farther away meets none of its voxels
  IndexBox region_voxels;  ///< no voxel outside scores
  IndexBox workspace;      ///< voxels outside are transparent
  bool has_workspace;
  bool unknown_blocks;
  double voxel_size_m;
  float min_t;
  float max_t;
  const GainWindow* windows;
  std::uint32_t window_count;
  const std::uint32_t* first_windows;  ///< for each kTilesPerHint tiles: the window of the first of them
  const float* coordinates;
  std::uint64_t* gains;  ///< one per window
};

/// Tells whether a ray surely passes a sphere's voxels by, within the rounding of float.
[[nodiscard]] SACCADE_HD inline bool misses_sphere(const float (&center)[3], float radius_vox, const LatticeRay& ray) {
  constexpr float kRounding{1e-5F};
  const float along = center[0] * ray.d[0] + center[1] * ray.d[1] + center[2] * ray.d[2];
  const float center_squared = center[0] * center[0] + center[1] * center[1] + center[2] * center[2];
  const float d_squared = ray.d[0] * ray.d[0] + ray.d[1] * ray.d[1] + ray.d[2] * ray.d[2];
  return center_squared * d_squared - along * along >
         (radius_vox * radius_vox + kRounding * center_squared) * d_squared;
}

/// Walks a ray to the first voxel that stops it, and tells whether that scores.
[[nodiscard]] SACCADE_HD inline bool ray_scores(const GainArguments& a, const LatticeRay& ray) {
  const MapView& map = a.map;
  const RaySpan region = clip(ray, a.region_voxels);
  if (region.empty()) return false;
  // As RaySpan::until, by value: a reference to one of two events would put both on the stack.
  RaySpan span{kRayStart, after_depth(a.max_t)};
  const bool leaves = before(region.exit, span.exit);
  span.exit.t = leaves ? region.exit.t : span.exit.t;
  span.exit.axis = leaves ? region.exit.axis : span.exit.axis;
  if (span.empty()) return false;
  bool scores{false};
  const auto visit_voxel = [&](BrickEntry entry, const Index3& voxel, const RaySpan& in_voxel) {
    if (a.has_workspace && !a.workspace.contains(voxel)) return false;
    bool is_unknown{true};
    if (entry.stored()) {
      const int child = child_index(voxel);
      const std::uint64_t word = std::uint64_t{entry.slot()} * kBrickWords + static_cast<std::uint64_t>(child >> 6);
      // Both at once: most voxels on the way are empty, and a second wait for memory would follow the first.
      const std::uint64_t unknown = map.unknown[word] >> (child & 63);
      const std::uint64_t occupied = map.occupied[word] >> (child & 63);
      if (((unknown | occupied) & 1U) == 0) return false;
      is_unknown = (unknown & 1U) != 0;
    }
    const bool may_score = is_unknown && a.region.contains(voxel, a.voxel_size_m);
    if (is_unknown && !may_score && !a.unknown_blocks) return false;
    scores = may_score && in_voxel.enter.axis >= 0 && in_voxel.enter.t >= a.min_t;
    return true;
  };
  const auto visit_brick = [&](const Index3& brick, const RaySpan& in_brick) {
    const BrickEntry entry = map.entry(brick);
    if (entry.clear()) return false;
    return walk_cells<kVoxelLevel>(ray, in_brick, [&](const Index3& voxel, const RaySpan& in_voxel) {
      return visit_voxel(entry, voxel, in_voxel);
    });
  };
  walk_cells<kBlockLevel>(ray, span, [&](const Index3& block, const RaySpan& in_block) {
    if (map.blocks.contains(block) && map.block_stops[map.blocks.at(block)] == 0) return false;
    return walk_cells<kBrickLevel>(ray, in_block, visit_brick);
  });
  return scores;
}

/// A block casts a tile of a window, a ray per thread.
struct CountScoringRays {
  using Arguments = GainArguments;
  struct Shared {
    std::uint32_t scoring;
    std::uint32_t window;
    std::uint32_t tile;  ///< its number in the window
  };
  static constexpr const char* kName{"saccade_count_scoring_rays"};
  static constexpr unsigned kThreads{kTileColumns * kTileRows};
  static constexpr unsigned kBlocksPerUnit{10};  // 88 registers at most; one block more spills some
  static constexpr int kPhases{3};

  /// Finds a tile's window from the host's hint; every window has a tile, so that it is near.
  [[nodiscard]] static SACCADE_HD std::uint32_t window_of(const Arguments& a, std::uint32_t tile) {
    std::uint32_t window = a.first_windows[tile / kTilesPerHint];
    while (window + 1 < a.window_count && a.windows[window + 1].first_tile <= tile) ++window;
    return window;
  }

  template <int kPhase>
  static SACCADE_HD void run(const Arguments& a, Shared& shared, const Thread& thread) {
    if constexpr (kPhase == 0) {
      if (thread.index != 0) return;
      const std::uint32_t window = window_of(a, thread.block);
      shared = {0, window, thread.block - a.windows[window].first_tile};
    } else if constexpr (kPhase == 1) {
      const GainWindow& window = a.windows[shared.window];
      const std::uint32_t tile = shared.tile;
      const std::uint32_t tiles_across = (window.columns + kTileColumns - 1) / kTileColumns;
      const std::uint32_t column = tile % tiles_across * kTileColumns + thread.index % kTileColumns;
      const std::uint32_t row = tile / tiles_across * kTileRows + thread.index / kTileColumns;
      if (column >= window.columns || row >= window.rows) return;
      const float at_a = a.coordinates[window.first_a + column];
      const float at_b = a.coordinates[window.first_b + row];
      const LatticeRay ray = make_lattice_ray(window.origin, window.x[0] * at_a + (window.y[0] * at_b + window.z[0]),
                                              window.x[1] * at_a + (window.y[1] * at_b + window.z[1]),
                                              window.x[2] * at_a + (window.y[2] * at_b + window.z[2]));
      if (a.region.kind == RegionShape::Kind::sphere && misses_sphere(window.to_center, a.radius_vox, ray)) return;
      if (ray_scores(a, ray)) atomic_add(shared.scoring, 1U);
    } else {
      if (thread.index == 0 && shared.scoring != 0) {
        atomic_add(a.gains[shared.window], std::uint64_t{shared.scoring});
      }
    }
  }
};

/// Marks the blocks of bricks that hold a voxel that is not empty, a block per thread.
struct MarkBlocks {
  struct Arguments {
    MapView map;
  };
  struct Shared {};
  static constexpr const char* kName{"saccade_mark_blocks"};
  static constexpr unsigned kThreads{128};
  static constexpr unsigned kBlocksPerUnit{1};
  static constexpr int kPhases{1};

  template <int kPhase>
  static SACCADE_HD void run(const Arguments& a, Shared& /*shared*/, const Thread& thread) {
    const std::uint64_t at = std::uint64_t{thread.block} * kThreads + thread.index;
    if (at >= a.map.blocks.count()) return;
    const Index3 first = a.map.blocks.index(at) * kBlockBrickEdge;
    bool stops{false};
    for (int i = 0; i < kBlockBrickEdge * kBlockBrickEdge * kBlockBrickEdge && !stops; ++i) {
      stops = !a.map.entry(first + Index3{i & 3, (i >> 2) & 3, i >> 4}).clear();
    }
    a.map.block_stops[at] = stops ? 1 : 0;
  }
};

}  // namespace saccade::internal::cuda
