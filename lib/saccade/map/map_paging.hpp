// SPDX-License-Identifier: Apache-2.0
#pragma once
// PagingConfig, PagingStats: a map whose sectors go to a store when memory is limited. with_in_memory: a part of such a
// map for its readers.

#include <memory>
#include <optional>
#include <span>

#include "saccade/core/executor.hpp"
#include "saccade/map/sector_store.hpp"
#include "saccade/map/tsdf_grid.hpp"

namespace saccade {

/// Limits of what a map keeps in memory. What goes out is written only where it changed since it was last stored, and
/// comes back when a frame or a view needs it. The content of the map never depends on the limits.
struct PagingConfig {
  /// Heap bytes of sectors and bricks; those that were looked at least recently go out. None: no limit. The sectors of
  /// one frame are in memory together, also where they need more.
  std::optional<std::size_t> memory_bytes;
  /// Edge of a cube around the camera, metres; sectors outside go out. It is shifted, by whole sectors, when the camera
  /// leaves its middle, which is half as large: the moving volume of thesis §2.2.2. None: no such volume.
  std::optional<double> moving_volume_m;
  std::shared_ptr<SectorStore> store;  ///< required

  /// Answers invalid_argument without a store or a limit, and for a volume that is not positive.
  [[nodiscard]] Status validate() const;
};

/// Counts of what paging did so far.
struct PagingStats {
  std::size_t sectors_away{0};    ///< in the store now, not in memory
  std::size_t sectors_out{0};     ///< times that a sector went out
  std::size_t sectors_in{0};      ///< times that a sector came back
  std::size_t bytes_written{0};   ///< to the store
  std::size_t bytes_read{0};      ///< from the store
  std::size_t map_bytes{0};       ///< in memory now
  std::size_t peak_map_bytes{0};  ///< largest map_bytes, also within a frame
  std::size_t shifts{0};          ///< moves of the volume
};

/// Returns the grid with the given sectors in memory; those that were there already stay, too. Others are left away.
/// For readers of a part of a map: a ray cast, a mesh. Errors: those of StoredSector::read. O(sectors + bytes read).
[[nodiscard]] Result<TsdfGrid> with_in_memory(const TsdfGrid& grid, std::span<const Index3> sectors,
                                              const Executor& executor);

}  // namespace saccade
