// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfaceTable: the cells that the mapped surface crosses.

#include <optional>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/map/tsdf_grid.hpp"

namespace saccade {

/// The cells that hold a zero crossing: all eight corners known, at least one occupied and one empty. A cell lies
/// between eight voxel centres and is named by its lowest corner, in bricks and sectors like that voxel. One bit per
/// cell, from the bricks' masks alone. O(bricks with occupied voxels) to build. Borrows the grid.
class SurfaceTable {
 public:
  SurfaceTable(const TsdfGrid& grid, const Executor& executor);

  [[nodiscard]] const SectorTable& sectors() const { return sectors_; }

  struct SectorSurface {
    Mask512 bricks;                       ///< bricks with such cells
    const Mask512* cells{nullptr};        ///< theirs, in the order of their bits
    std::array<std::uint16_t, 8> rank{};  ///< bits set in the words before

    /// Only for a brick whose bit is set.
    [[nodiscard]] const Mask512& of_brick(int i) const {
      const auto word = static_cast<std::size_t>(i >> 6);
      const std::uint64_t below = bricks.words[word] & ((std::uint64_t{1} << (i & 63)) - 1);
      return cells[rank[word] + static_cast<std::size_t>(std::popcount(below))];
    }
  };
  /// nullptr: no surface in that sector.
  [[nodiscard]] const SectorSurface* find(const Index3& sector) const;

  /// Calls body(brick index) for every brick with surface cells, in z-y-x order of sectors and bricks.
  template <class Body>
  void for_each_brick(const Body& body) const {
    for (std::size_t s = 0; s < keys_.size(); ++s) {
      for (int i = 0; i < kSectorBricks; ++i) {
        if (surfaces_[s].bricks.test(i)) body(keys_[s] * kSectorEdge + child_offset(i));
      }
    }
  }

 private:
  SectorTable sectors_;
  std::vector<Index3> keys_;
  std::vector<SectorSurface> surfaces_;
  std::vector<std::vector<Mask512>> cells_;
  std::vector<const SectorSurface*> flat_;  // like the sector table; empty when that is not flat
};

}  // namespace saccade
