// SPDX-License-Identifier: Apache-2.0
#pragma once
// TsdfConfig, TsdfGrid (sectors of bricks in a hash, copy-on-write) and SectorTable (flat look-up for rays).

#include <optional>
#include <unordered_map>
#include <vector>

#include "saccade/core/region.hpp"
#include "saccade/core/result.hpp"
#include "saccade/map/brick.hpp"

namespace saccade {

struct TsdfConfig {
  double voxel_size_m{0.0058};
  double truncation_vox{4.0};     ///< M_v of eq. 2.2 in voxels
  std::uint16_t max_weight{128};  ///< M_w of eq. 2.3; at most 500, so that averaging is exact in float
  std::uint16_t free_weight{5};   ///< W_th: where v = 1 the weight saturates here; 1 … 7
  /// Weight in percent of a ray that passes a surface by, as evidence against the surface; 1 … 100. 100 is eq. 2.2
  /// unchanged: docs/decisions/0021-clearing.md.
  std::uint8_t clearing_percent{100};
  bool color{true};              ///< fuse colours where frames have them
  std::optional<Box> workspace;  ///< limit of unknown space: voxels outside are transparent to view rays

  [[nodiscard]] double truncation_m() const { return truncation_vox * voxel_size_m; }
  [[nodiscard]] float clearing_share() const { return static_cast<float>(clearing_percent) / 100.0F; }
  [[nodiscard]] Status validate() const;
};

/// Returns the voxels whose centre lies in the box: exactly those v with lo ≤ v < hi.
[[nodiscard]] IndexBox voxels_with_center_in(const Box& box, double voxel_size_m);

/// Content of the map: every voxel of space, stored where it was observed. A copy shares all sectors (microseconds);
/// writing to a copy unshares only what is written. Const use from many threads is safe.
class TsdfGrid {
 public:
  /// Returns nullptr for a sector in which every voxel is unknown.
  [[nodiscard]] const Sector* find(const Index3& sector) const;
  /// Returns a sector to write, created if absent, unshared if shared. References stay valid until the sector is
  /// erased.
  [[nodiscard]] Sector& writable(const Index3& sector);
  /// Returns an existing sector to write. Several threads at once may ask for distinct sectors.
  [[nodiscard]] Sector& writable_existing(const Index3& sector);
  void erase(const Index3& sector) { sectors_.erase(sector); }

  [[nodiscard]] Voxel voxel(const Index3& voxel) const;
  [[nodiscard]] VoxelState state(const Index3& voxel) const { return state_of(this->voxel(voxel)); }
  /// Returns nullopt where no colour was fused.
  [[nodiscard]] std::optional<Rgb8> color(const Index3& voxel) const;

  [[nodiscard]] std::size_t sector_count() const { return sectors_.size(); }
  [[nodiscard]] bool empty() const { return sectors_.empty(); }
  /// Returns the keys in z-y-x order.
  [[nodiscard]] std::vector<Index3> sorted_sectors() const;
  /// Returns the smallest box around all sectors, in sectors; empty where there are none.
  [[nodiscard]] IndexBox sector_bounds() const;
  /// Returns the smallest box, in voxels, around all bricks with a known voxel; empty where there are none. O(bricks).
  [[nodiscard]] IndexBox known_bounds() const;

  struct Usage {
    std::size_t sectors{0};
    std::size_t constant_free_bricks{0};
    std::size_t free_bricks{0};
    std::size_t dense_bricks{0};
    std::size_t bytes{0};  ///< heap bytes of sectors and bricks
    [[nodiscard]] std::size_t bricks() const { return constant_free_bricks + free_bricks + dense_bricks; }
  };
  [[nodiscard]] Usage usage() const;
  /// Tells whether the content is equal, brick by brick.
  [[nodiscard]] bool operator==(const TsdfGrid& other) const;

 private:
  std::unordered_map<Index3, SectorRef, Index3Hash> sectors_;
};

/// Flat table of the sectors within a box, which spares walking rays the hashing. Borrows the grid, which must not be
/// written meanwhile. (Where sectors lie so far apart that the table would be huge, it looks them up by hash.)
class SectorTable {
 public:
  SectorTable() = default;
  /// Covers `box` (in sectors), clipped to the grid's bounds.
  SectorTable(const TsdfGrid& grid, const IndexBox& box);
  explicit SectorTable(const TsdfGrid& grid) : SectorTable{grid, grid.sector_bounds()} {}

  [[nodiscard]] const IndexBox& box() const { return box_; }
  /// Returns nullptr for a sector that is unknown or outside the table.
  [[nodiscard]] const Sector* find(const Index3& sector) const {
    if (!box_.contains(sector)) return nullptr;
    return sparse_grid_ != nullptr ? sparse_grid_->find(sector) : sectors_[flat_index(sector)];
  }
  /// Tells whether look-ups are array accesses.
  [[nodiscard]] bool is_flat() const { return sparse_grid_ == nullptr; }
  /// Returns the position of a sector of the box in z-y-x order. Requires is_flat().
  [[nodiscard]] std::size_t flat_index(const Index3& sector) const {
    const Index3 i = sector - box_.lo;
    return (static_cast<std::size_t>(i.z) * size_y_ + static_cast<std::size_t>(i.y)) * size_x_ +
           static_cast<std::size_t>(i.x);
  }

 private:
  IndexBox box_;
  const TsdfGrid* sparse_grid_{nullptr};
  std::size_t size_x_{0};
  std::size_t size_y_{0};
  std::vector<const Sector*> sectors_;
};

}  // namespace saccade
