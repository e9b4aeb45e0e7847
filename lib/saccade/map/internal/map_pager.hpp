// SPDX-License-Identifier: Apache-2.0
#pragma once
// MapPager: chooses which sectors of a map are in memory, and moves them. Used by TsdfMap.

#include <Eigen/Core>
#include <unordered_map>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/map/map_paging.hpp"

namespace saccade {

/// A sector as it was read from its store.
struct LoadedSector {
  Index3 key;
  SectorRef ref;
};

/// Reads the sectors among `keys` that are away, in their order. Answers the first error of StoredSector::read.
[[nodiscard]] Result<std::vector<LoadedSector>> read_away(const TsdfGrid& grid, std::span<const Index3> keys,
                                                          const Executor& executor);

/// Pager of one grid: the grid of all calls is the same one. Which sectors go out never depends on the threads.
class MapPager {
 public:
  /// Takes a valid configuration, and the grid as it is.
  MapPager(const PagingConfig& config, double voxel_size_m, const TsdfGrid& grid);

  /// Makes room for the needed sectors and brings them in, before they are read or written. On an error, the content of
  /// the grid is as it was: only where sectors are may differ.
  /// @param camera_world where the camera is, for the moving volume; null: as before.
  [[nodiscard]] Status bring_in(TsdfGrid& grid, std::span<const Index3> needed, const Eigen::Vector3d* camera_world,
                                const Executor& executor);
  /// Takes note of sectors that were made, written or erased, and keeps the limits where the store allows it; where it
  /// does not, the next bring_in says so.
  void settle(TsdfGrid& grid, std::span<const Index3> written, const Executor& executor);
  /// Takes all sectors out of memory.
  [[nodiscard]] Status page_out_all(TsdfGrid& grid, const Executor& executor);

  [[nodiscard]] const PagingStats& stats() const { return stats_; }

 private:
  struct Resident {
    std::size_t bytes{0};
    std::uint64_t seen{0};  ///< clock_ when it was last needed
  };
  using Residents = std::unordered_map<Index3, Resident, Index3Hash>;

  void note(const Index3& key, std::size_t bytes);
  void forget(const Index3& key);
  [[nodiscard]] bool is_inside(const Index3& key) const { return !config_.moving_volume_m || volume_.contains(key); }
  /// Moves the volume where the camera left its middle. Returns whether it moved.
  bool shift(const Eigen::Vector3d& camera_world);
  /// Returns what has to go out so that the limits hold with `incoming` bytes more: first what lies outside the volume,
  /// then what was needed least recently. Sectors needed since `spare` stay.
  [[nodiscard]] std::vector<Index3> surplus(std::size_t incoming, std::uint64_t spare) const;
  [[nodiscard]] Status take_out(TsdfGrid& grid, std::span<const Index3> keys, const Executor& executor);
  [[nodiscard]] Status put_in(TsdfGrid& grid, std::span<const Index3> keys, const Executor& executor);
  /// Returns the away sectors of the volume that still fit into the memory.
  [[nodiscard]] std::vector<Index3> returning(const TsdfGrid& grid) const;

  PagingConfig config_;
  double sector_m_;
  Residents residents_;
  IndexBox volume_;               ///< sectors of the moving volume
  Eigen::Vector3d center_world_;  ///< its middle
  bool is_placed_{false};         ///< whether the volume is anywhere yet
  std::uint64_t clock_{1};
  PagingStats stats_;
};

}  // namespace saccade
