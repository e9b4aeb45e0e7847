// SPDX-License-Identifier: Apache-2.0
#pragma once
// CastLimits, ShownPixels, and GainCaster, which counts the rays of a window that score.

#include <cstdint>
#include <span>
#include <vector>

#include "saccade/views/internal/ray_beam.hpp"
#include "saccade/views/internal/stop_grid.hpp"
#include "saccade/views/internal/voxel_set.hpp"
#include "saccade/views/view_gain.hpp"

namespace saccade {

/// The pixels of a window that a footprint shows; window pixel (0, 0) is (column, row) of the footprint.
struct ShownPixels {
  const Footprint* footprint{nullptr};  ///< nullptr: all are shown
  int column{0};
  int row{0};
};

/// How far and by which savings rays are cast.
struct CastLimits {
  float min_t{0.0F};
  float max_t{0.0F};
  GainSavings savings;
};

/// Casts the rays of a window through a stop grid. Tiles of rays go through what is the same for all of them, by slabs
/// of bricks, then of voxels; what remains undecided is split, and in the end walked ray by ray. One thread each.
class GainCaster {
 public:
  /// `seen` takes the voxels in which rays end; nullptr: only rays are counted. All arguments outlive the caster.
  /// Only rays through pixels that are shown are looked at.
  GainCaster(const StopGrid& grid, const CastWindow& window, const CastLimits& limits, VoxelSet* seen,
             const ShownPixels& shown = {});

  /// Casts rows [begin, end) of the window.
  void cast_rows(int begin, int end);

  /// Like cast_rows for the whole window, but tiles of at most so many pixels that are still undecided are left open.
  void look_over(int tile_px);
  /// Casts some rays of the open tiles, to judge how many of theirs score; those that seem to score least come first.
  void judge_open_tiles();
  /// Decides open tiles, one after the other, until none is left or the window scores less than enough for certain.
  void refine(std::uint64_t enough);
  [[nodiscard]] bool decided() const { return open_tiles_.empty(); }
  [[nodiscard]] std::uint64_t open_rays() const { return open_rays_; }

  [[nodiscard]] std::uint64_t scored() const { return scored_; }
  [[nodiscard]] std::uint64_t rays_cast() const { return rays_cast_; }

 private:
  class Sight;
  struct OpenTile {
    Tile tile;
    std::uint64_t rays{0};
    double scoring{0.0};  ///< about how many of them
  };

  void cast_tile(const Tile& tile);
  void look_by_bricks(const RayBeam& beam, int last, Sight& sight) const;
  void look_by_voxels(const RayBeam& beam, int last, Sight& sight) const;
  bool look_closer(const RayBeam& beam, int n, int end, Sight& sight) const;
  void decide(const Tile& tile);
  void split(const Tile& tile);
  void cast_rays(const Tile& tile);
  void cast_packet(const Tile& tile);
  /// The rays that wait for others come to their ends.
  void finish() { scored_ += finish_rays(window_.rays.origin, grid_.flat(), limits_.min_t, waiting_); }
  /// Whether all open rays together could make it enough; the same whatever the vectors' width.
  [[nodiscard]] bool may_be(std::uint64_t enough) {
    if (scored_ + open_rays_ < enough && scored_ + open_rays_ + waiting_.count >= enough) finish();
    return scored_ + open_rays_ >= enough;
  }
  void judge(std::span<OpenTile> tiles);
  [[nodiscard]] RayPacket no_rays(int major, int slab) const;
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
  int finest_slabs_;  ///< of voxels, that tiles look at
  int leave_open_px_{0};
  WaitingRays waiting_;  ///< of packets; all with an end to cast_rows, and to refine if no tile is left open
  std::vector<OpenTile> open_tiles_;
  std::uint64_t open_rays_{0};
  std::uint64_t scored_{0};
  std::uint64_t rays_cast_{0};
};

}  // namespace saccade
