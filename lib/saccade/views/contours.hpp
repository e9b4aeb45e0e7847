// SPDX-License-Identifier: Apache-2.0
#pragma once
// ContourConfig; ContourVoxel and contour_voxels: empty voxels at the border of incomplete surfaces, with the normal of
// the frontier; ContourPoint and contour_points: groups of them.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/angle.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/map/map_changes.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade {

/// Parameters of contours. Thesis §3.1.1.
struct ContourConfig {
  std::uint16_t known_weight{5};   ///< W_th: voxels observed less often count as unknown
  double group_distance_m{0.03};   ///< D_th: voxels of a group are nearer to its first one
  double group_angle_rad{30_deg};  ///< A_th: their normals are nearer to its normal

  /// invalid_argument for a weight of zero, a distance that is not positive or an angle outside (0, 90°].
  [[nodiscard]] Status validate() const;
};

/// An empty voxel next to unknown space and near an occupied voxel. Its normal points towards known empty space.
struct ContourVoxel {
  Index3 voxel;
  Eigen::Vector3f normal{Eigen::Vector3f::Zero()};  ///< of the frontier (eq. 3.5), unit length
  [[nodiscard]] bool operator==(const ContourVoxel&) const = default;
};

/// All contour voxels of a map. Thesis §3.1.1, eq. 3.2, 3.5, 3.6.
///
/// Known is a voxel observed known_weight times or more, by the map's weights; where the map's free_weight is less than
/// that, only voxels within the truncation are ever known to be empty. Outside the map's workspace nothing is unknown:
/// a voxel there is no contour voxel, makes none, and counts nothing in a normal unless it is known. In eq. 3.6 free
/// space whose weight is saturated counts W_th (docs/decisions/0009-contours.md). A voxel whose normal vanishes
/// says nothing about where to look from, and is left out.
/// @return by sector, brick and voxel, each in z-y-x order; invalid_argument for a bad config.
/// O(bricks near the surface + contour voxels). The thread count never changes a bit of the result.
[[nodiscard]] Result<std::vector<ContourVoxel>> contour_voxels(const TsdfSnapshot& map, const ContourConfig& config,
                                                               const Executor& executor);

/// The contour voxels of these bricks, per sector; the sectors need not exist. For a valid configuration (contract).
[[nodiscard]] std::vector<std::vector<ContourVoxel>> contour_voxels_in(const TsdfSnapshot& map,
                                                                       std::span<const SectorBricks> sectors,
                                                                       const ContourConfig& config,
                                                                       const Executor& executor);

/// A group of similar contour voxels: their mean.
struct ContourPoint {
  Eigen::Vector3d position_m{Eigen::Vector3d::Zero()};
  Eigen::Vector3d normal{Eigen::Vector3d::Zero()};  ///< unit length
  std::uint32_t voxels{0};                          ///< how many there are
  [[nodiscard]] bool operator==(const ContourPoint&) const = default;
};

/// Similar contour voxels, each group as one point. Thesis §3.1.1, eq. 3.7, whose second line is meant as "the angle
/// between the normals is less than A_th": as printed, opposite normals would be alike.
///
/// The first voxel that is in no group yet starts one and takes all that are in none and similar to itself. Similarity
/// to the first one bounds a group: if similar voxels were chained, one group would run along a whole edge, or all
/// around a round thing, and its mean would lie on neither. So no group is wider than 2 D_th, no two of its normals
/// differ by 2 A_th, and their mean never vanishes (docs/decisions/0009-contours.md).
/// Groups are in the order of their first voxels. For a valid configuration and voxels with unit normals (contract).
/// O(voxels · groups within D_th of each). One thread.
[[nodiscard]] std::vector<ContourPoint> contour_points(std::span<const ContourVoxel> voxels, double voxel_size_m,
                                                       const ContourConfig& config);

}  // namespace saccade
