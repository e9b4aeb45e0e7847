// SPDX-License-Identifier: Apache-2.0
#pragma once
// TsdfConfig, TsdfGrid (sectors of bricks in a hash, copy-on-write) and SectorTable (flat look-up for rays).

#include <memory>
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
///
/// Sectors of a paged map may be away: their content is in a SectorStore, and the grid knows where (map_paging.hpp). An
/// away sector never reads as unknown or empty: find, writable, voxel and the look-ups of SectorTable throw a
/// ContractViolation for it.
class TsdfGrid {
 public:
  /// Returns nullptr for a sector in which every voxel is unknown. Requires a sector that is not away.
  [[nodiscard]] const Sector* find(const Index3& sector) const;
  /// Returns a sector to write, created if absent, unshared if shared. References stay valid until the sector is
  /// erased.
  [[nodiscard]] Sector& writable(const Index3& sector);
  /// Returns an existing sector to write. Several threads at once may ask for distinct sectors.
  [[nodiscard]] Sector& writable_existing(const Index3& sector);
  void erase(const Index3& sector) {
    sectors_.erase(sector);
    if (!away_.empty()) away_.erase(sector);
  }

  /// Tells whether the sector holds anything known, wherever it is.
  [[nodiscard]] bool holds(const Index3& sector) const { return sectors_.contains(sector) || is_away(sector); }
  [[nodiscard]] bool all_in_memory() const { return away_.empty(); }
  [[nodiscard]] bool is_away(const Index3& sector) const { return !away_.empty() && away_.contains(sector); }
  [[nodiscard]] std::size_t away_count() const { return away_.size(); }
  /// Returns the handle of an away sector; null for any other.
  [[nodiscard]] std::shared_ptr<const StoredSector> away(const Index3& sector) const;
  /// Returns the away sectors of a box, in z-y-x order. O(away sectors).
  [[nodiscard]] std::vector<Index3> away_in(const IndexBox& box) const;
  /// Returns the handle of a sector in memory; a null one where it is unknown or away.
  [[nodiscard]] SectorRef in_memory(const Index3& sector) const;
  /// Returns the sector wherever it is, read from its store where it is away; a null handle where it is unknown. The
  /// grid stays as it is. Errors: those of StoredSector::read.
  [[nodiscard]] Result<SectorRef> read(const Index3& sector) const;
  /// Takes a sector in memory out of it. Requires a stored copy of equal content.
  void page_out(const Index3& sector, std::shared_ptr<const StoredSector> stored);
  /// Puts an away sector, as it was read, into memory.
  void page_in(const Index3& sector, SectorRef loaded);
  /// Remembers that the store holds the content of a sector in memory. Requires an unshared sector that exists.
  void set_stored(const Index3& sector, std::shared_ptr<const StoredSector> stored);

  [[nodiscard]] Voxel voxel(const Index3& voxel) const;
  [[nodiscard]] VoxelState state(const Index3& voxel) const { return state_of(this->voxel(voxel)); }
  /// Returns the unknown voxels of a brick. Requires a sector that is not away.
  [[nodiscard]] Mask512 unknown_in(const Index3& brick) const;
  /// Returns nullopt where no colour was fused.
  [[nodiscard]] std::optional<Rgb8> color(const Index3& voxel) const;

  [[nodiscard]] std::size_t sector_count() const { return sectors_.size() + away_.size(); }
  [[nodiscard]] bool empty() const { return sectors_.empty() && away_.empty(); }
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
    std::size_t bytes{0};         ///< heap bytes of sectors and bricks in memory
    std::size_t away_sectors{0};  ///< among the sectors
    std::size_t away_bytes{0};    ///< heap bytes that these will need in memory
    [[nodiscard]] std::size_t bricks() const { return constant_free_bricks + free_bricks + dense_bricks; }
  };
  [[nodiscard]] Usage usage() const;
  /// Tells whether the content is equal, brick by brick. Reads away sectors; requires that this works.
  [[nodiscard]] bool operator==(const TsdfGrid& other) const;

 private:
  std::unordered_map<Index3, SectorRef, Index3Hash> sectors_;                         ///< in memory
  std::unordered_map<Index3, std::shared_ptr<const StoredSector>, Index3Hash> away_;  ///< no key is in both
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
  /// Returns nullptr for a sector that is unknown or outside the table. Requires a sector that is not away.
  [[nodiscard]] const Sector* find(const Index3& sector) const {
    if (!box_.contains(sector)) return nullptr;
    if (sparse_grid_ != nullptr) return sparse_grid_->find(sector);
    const Sector* found = sectors_[flat_index(sector)];
    if (found == &kAway) [[unlikely]]
      refuse_away(sector);
    return found;
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
  static const Sector kAway;  ///< stands for any sector that is away
  [[noreturn]] static void refuse_away(const Index3& sector);

  IndexBox box_;
  const TsdfGrid* sparse_grid_{nullptr};
  std::size_t size_x_{0};
  std::size_t size_y_{0};
  std::vector<const Sector*> sectors_;
};

}  // namespace saccade
