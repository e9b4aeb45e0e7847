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
  /// How much it counts against a surface when a ray passes it by; 1 … 100, which is eq. 2.2 as it stands:
  /// docs/decisions/0021-clearing.md.
  std::uint8_t clearing_percent{100};
  bool color{true};              ///< fuse colours where frames have them
  std::optional<Box> workspace;  ///< bounds what is unknown: voxels outside are transparent to view rays

  [[nodiscard]] double truncation_m() const { return truncation_vox * voxel_size_m; }
  [[nodiscard]] float clearing_share() const { return static_cast<float>(clearing_percent) / 100.0F; }
  [[nodiscard]] Status validate() const;
};

/// Voxels whose centre lies in the box: exactly those v with lo ≤ v < hi.
[[nodiscard]] IndexBox voxels_with_center_in(const Box& box, double voxel_size_m);

/// The map's content: every voxel of space, stored where it was observed. Copying shares all sectors (microseconds);
/// writing to a copy unshares only what is written. Const use from many threads is safe.
class TsdfGrid {
 public:
  /// nullptr: every voxel in there is unknown.
  [[nodiscard]] const Sector* find(const Index3& sector) const;
  /// For writing: created if absent, unshared if shared. References stay valid until the sector is erased.
  [[nodiscard]] Sector& writable(const Index3& sector);
  /// A sector to write that is known to exist. Distinct sectors may be asked for from several threads at once.
  [[nodiscard]] Sector& writable_existing(const Index3& sector);
  void erase(const Index3& sector) { sectors_.erase(sector); }

  [[nodiscard]] Voxel voxel(const Index3& voxel) const;
  [[nodiscard]] VoxelState state(const Index3& voxel) const { return state_of(this->voxel(voxel)); }
  /// nullopt where no colour was fused.
  [[nodiscard]] std::optional<Rgb8> color(const Index3& voxel) const;

  [[nodiscard]] std::size_t sector_count() const { return sectors_.size(); }
  [[nodiscard]] bool empty() const { return sectors_.empty(); }
  /// Keys in z-y-x order.
  [[nodiscard]] std::vector<Index3> sorted_sectors() const;
  /// Smallest box of sectors that holds all; empty box when there are none.
  [[nodiscard]] IndexBox sector_bounds() const;
  /// In voxels: smallest box around all bricks that hold a known voxel; empty box when there are none. O(bricks).
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
  /// Equal content, brick by brick.
  [[nodiscard]] bool operator==(const TsdfGrid& other) const;

 private:
  std::unordered_map<Index3, SectorRef, Index3Hash> sectors_;
};

/// Flat table of the sectors within a box, so that walking rays does no hashing. Borrows the grid, which must not be
/// written meanwhile. (A map whose sectors lie so far apart that the table would be huge is looked up by hash.)
class SectorTable {
 public:
  SectorTable() = default;
  /// Covers `box` (in sectors) cut to the grid's bounds.
  SectorTable(const TsdfGrid& grid, const IndexBox& box);
  explicit SectorTable(const TsdfGrid& grid) : SectorTable{grid, grid.sector_bounds()} {}

  [[nodiscard]] const IndexBox& box() const { return box_; }
  /// nullptr: unknown, or outside the table.
  [[nodiscard]] const Sector* find(const Index3& sector) const {
    if (!box_.contains(sector)) return nullptr;
    return sparse_grid_ != nullptr ? sparse_grid_->find(sector) : sectors_[flat_index(sector)];
  }
  /// Whether look-ups are array accesses.
  [[nodiscard]] bool is_flat() const { return sparse_grid_ == nullptr; }
  /// Position of a sector of the box in z-y-x order; only when is_flat().
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
