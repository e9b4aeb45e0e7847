// SPDX-License-Identifier: Apache-2.0
#pragma once
// CastLimits, ShownPixels, and GainCaster, which counts the scoring rays of a window.

#include <cstdint>
#include <span>
#include <vector>

#include "saccade/views/internal/ray_beam.hpp"
#include "saccade/views/internal/stop_grid.hpp"
#include "saccade/views/internal/voxel_set.hpp"
#include "saccade/views/view_gain.hpp"

namespace saccade {

/// Pixels of a window that a footprint shows; window pixel (0, 0) is (column, row) of the footprint.
struct ShownPixels {
  const Footprint* footprint{nullptr};  ///< nullptr: all pixels are shown
  int column{0};
  int row{0};
};

/// Limits of ray casting, and the savings in use.
struct CastLimits {
  float min_t{0.0F};
  float max_t{0.0F};
  GainSavings savings;
};

/// Caster of a window's rays through a stop grid. Tiles of rays jointly pass slabs that are alike for all of them,
/// first of bricks, then of voxels. Undecided tiles are split, and finally walked ray by ray. One per thread.
class GainCaster {
 public:
  /// `seen` collects the voxels in which rays end; nullptr: only rays are counted. All arguments must outlive the
  /// caster. Only rays through shown pixels are cast.
  GainCaster(const StopGrid& grid, const CastWindow& window, const CastLimits& limits, VoxelSet* seen,
             const ShownPixels& shown = {});

  /// Casts rows [begin, end) of the window.
  void cast_rows(int begin, int end);

  /// As cast_rows for the whole window, but leaves undecided tiles of at most `tile_px` pixels open.
  void look_over(int tile_px);
  /// Casts some rays of the open tiles to estimate their scores; tiles likely to score least come first.
  void classify_open_tiles();
  /// Decides open tiles, one after the other, until none is left or the window certainly scores less than `enough`.
  void refine(std::uint64_t enough);
  [[nodiscard]] bool decided() const { return open_tiles_.empty(); }
  [[nodiscard]] std::uint64_t open_rays() const { return open_rays_; }

  [[nodiscard]] std::uint64_t scored() const { return scored_; }
  [[nodiscard]] std::uint64_t rays_cast() const { return rays_cast_; }

 private:
  class TileVisibility;
  struct OpenTile {
    Tile tile;
    std::uint64_t rays{0};
    double scoring{0.0};  ///< estimate of how many of them score
  };

  void cast_tile(const Tile& tile);
  void look_by_bricks(const RayBeam& beam, int last, TileVisibility& sight) const;
  void look_by_voxels(const RayBeam& beam, int last, TileVisibility& sight) const;
  bool look_closer(const RayBeam& beam, int n, int end, TileVisibility& sight) const;
  void decide(const Tile& tile);
  void split(const Tile& tile);
  void cast_rays(const Tile& tile);
  void cast_packet(const Tile& tile);
  /// Finishes the rays that wait for others.
  void finish() { scored_ += finish_rays(window_.rays.origin, grid_.flat(), limits_.min_t, waiting_); }
  /// Tells whether all open rays together could reach `enough`, regardless of the vectors' width.
  [[nodiscard]] bool may_be(std::uint64_t enough) {
    if (scored_ + open_rays_ < enough && scored_ + open_rays_ + waiting_.count >= enough) finish();
    return scored_ + open_rays_ >= enough;
  }
  void judge(std::span<OpenTile> tiles);
  [[nodiscard]] RayPacket empty_packet(int major, int slab) const;
  void add_rays(int begin, int end, int row, RayPacket& packet) const;
  void cast_ray(float a, float b, int major, int slab);
  void walk_bricks(const LatticeRay& ray, const RaySpan& span);
  void walk_voxels(const LatticeRay& ray, const RaySpan& span);
  [[nodiscard]] bool ends_in(const StopGrid::Brick& brick, const Index3& voxel, const RayEvent& entered);
  [[nodiscard]] std::uint64_t rays_in(const Tile& tile) const;
  [[nodiscard]] bool shows(int column, int row) const {
    return shown_.footprint == nullptr || shown_.footprint->test(column + shown_.column, row + shown_.row);
  }
  [[nodiscard]] bool shows_all(int begin, int end, int row) const {
    if (shown_.footprint == nullptr) return true;
    const int at = row + shown_.row;
    return shown_.footprint->count({begin + shown_.column, end + shown_.column, at, at + 1}) ==
           static_cast<std::uint64_t>(end - begin);
  }
  [[nodiscard]] int last_slab(const RayBeam& beam) const;
  void score(const Index3& voxel, const RayEvent& entered);

  const StopGrid& grid_;
  const CastWindow& window_;
  const CastLimits& limits_;
  VoxelSet* seen_;
  ShownPixels shown_;
  bool use_packets_;
  int finest_slabs_;  ///< finest slabs of voxels that tiles examine
  int leave_open_px_{0};
  RayQueue waiting_;  ///< rays of packets; cast_rows finishes all, refine too if no tile is left open
  std::vector<OpenTile> open_tiles_;
  std::uint64_t open_rays_{0};
  std::uint64_t scored_{0};
  std::uint64_t rays_cast_{0};
};

}  // namespace saccade
