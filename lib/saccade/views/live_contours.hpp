// SPDX-License-Identifier: Apache-2.0
#pragma once
// LiveContours: the contours of a map that goes on changing, brought up to date where it changed.

#include <cstddef>
#include <vector>

#include "saccade/views/contours.hpp"

namespace saccade {

/// What LiveContours::update did.
struct ContoursUpdate {
  std::size_t bricks_changed{0};  ///< in the map
  double ms{0.0};
};

/// Follows a map from snapshot to snapshot. After update(map), voxels() equals contour_voxels(map) to the bit.
/// Thesis §3.1.1.
///
/// Whether a voxel belongs to a contour, and its normal, depend on voxels next to it alone, so those of a changed brick
/// and of the up to 26 around it are found anew, all others are kept. Const use from many threads is safe, one writer
/// at a time. It holds the snapshot.
class LiveContours {
 public:
  /// invalid_argument when the configuration is.
  [[nodiscard]] static Result<LiveContours> create(const ContourConfig& config = {});

  /// Follows the map to this state, any later or earlier one, or that of another map; where the configurations of both
  /// maps differ, from scratch. O(changed_sectors + bricks around changed ones). The same for every thread count.
  ContoursUpdate update(const TsdfSnapshot& map, const Executor& executor);

  /// All contour voxels. O(voxels).
  [[nodiscard]] std::vector<ContourVoxel> voxels() const;
  /// Groups of them, as of contour_points.
  [[nodiscard]] std::vector<ContourPoint> points() const;

 private:
  struct Sector {
    Index3 key;
    std::vector<ContourVoxel> voxels;  ///< by brick and voxel
  };
  explicit LiveContours(const ContourConfig& config) : config_{config} {}
  void replace(const SectorBricks& stale, const std::vector<ContourVoxel>& fresh);

  ContourConfig config_;
  TsdfSnapshot map_;
  std::vector<Sector> sectors_;  ///< that have contour voxels, in z-y-x order
};

}  // namespace saccade
