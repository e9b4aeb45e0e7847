// SPDX-License-Identifier: Apache-2.0
#pragma once
// ContourSector: the contour voxels of a map, sector by sector. Used by contour_voxels_in.

#include <array>
#include <bitset>
#include <optional>
#include <vector>

#include "saccade/views/contours.hpp"

namespace saccade {

/// Finder of contour voxels by masks of whole bricks; only contour voxels get a normal computed. One per thread; map
/// and table must outlive it. About 130 KiB.
class ContourSector {
 public:
  ContourSector(const TsdfSnapshot& map, const SectorTable& table, std::uint16_t known_weight);

  /// Returns the contour voxels of these bricks, in order.
  [[nodiscard]] std::vector<ContourVoxel> find(const SectorBricks& bricks);

 private:
  static constexpr int kEdge{kSectorEdge + 2};  ///< bricks along an edge of the sector and its surroundings
  static constexpr std::size_t kBricks{std::size_t{kEdge} * kEdge * kEdge};

  /// Masks at the weight from which voxels are known. A voxel outside the workspace may be occupied, but not unknown.
  struct Masks {
    Mask512 occupied;
    Mask512 unknown;
  };

  void enter(const Index3& sector);
  [[nodiscard]] const BrickRef& brick(const Index3& local) const;
  [[nodiscard]] const Masks& masks(const Index3& local);
  [[nodiscard]] Mask512 contour(const Index3& local);
  [[nodiscard]] int modified_weight(const Index3& local_voxel) const;
  [[nodiscard]] std::optional<Eigen::Vector3f> frontier_normal(const Index3& local_voxel) const;

  const SectorTable* table_;
  int known_weight_;
  int free_weight_;
  std::optional<IndexBox> workspace_;
  Index3 sector_;
  std::array<const Sector*, 27> around_{};  ///< z slowest, the sector itself in the middle; nullptr: unknown
  std::vector<Masks> masks_;                ///< by brick, from -1 on along each axis
  std::bitset<kBricks> made_;               ///< masks that were computed
};

}  // namespace saccade
