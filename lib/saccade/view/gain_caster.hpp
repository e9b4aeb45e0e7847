// SPDX-License-Identifier: Apache-2.0
#pragma once
// VoxelSet, CastLimits, and GainCaster, which counts the rays of a window that score.

#include <cstdint>
#include <vector>

#include "saccade/view/cast_window.hpp"
#include "saccade/view/stop_grid.hpp"
#include "saccade/view/view_gain.hpp"

namespace saccade {

/// A set of voxels within a box.
class VoxelSet {
 public:
  explicit VoxelSet(const IndexBox& voxels);
  void insert(const Index3& voxel);
  [[nodiscard]] std::uint64_t count() const;

 private:
  IndexBox bricks_;
  std::vector<Mask512> masks_;
};

/// How far and by which savings rays are cast.
struct CastLimits {
  float min_t{0.0F};
  float max_t{0.0F};
  GainSavings savings;
};

/// Casts the rays of a window through a stop grid. One thread each.
class GainCaster {
 public:
  /// `seen` takes the voxels in which rays end; nullptr: only rays are counted. All arguments outlive the caster.
  GainCaster(const StopGrid& grid, const CastWindow& window, const CastLimits& limits, VoxelSet* seen);

  /// Casts rows [begin, end) of the window.
  void cast_rows(int begin, int end);

  [[nodiscard]] std::uint64_t scored() const { return scored_; }
  [[nodiscard]] std::uint64_t rays_cast() const { return rays_cast_; }

 private:
  /// A rectangle of rays that is still empty up to slab `slab` of bricks along the axis `major`.
  struct Tile {
    int column_begin, column_end, row_begin, row_end;
    int major;
    int slab;
  };
  struct Beam;

  void cast_tile(const Tile& tile);
  void cast_rays(const Tile& tile);
  void cast_ray(float a, float b, int major, int slab);
  void split(const Tile& tile);
  [[nodiscard]] bool to_be_cast(const Tile& tile) const;
  [[nodiscard]] Beam beam(const Tile& tile) const;
  [[nodiscard]] RayEvent slab_entry(const LatticeRay& ray, int major, int slab) const;
  void end_of_ray(const Index3& voxel, const RayEvent& entered);

  const StopGrid& grid_;
  const CastWindow& window_;
  const CastLimits& limits_;
  VoxelSet* seen_;
  std::uint64_t scored_{0};
  std::uint64_t rays_cast_{0};
};

}  // namespace saccade
