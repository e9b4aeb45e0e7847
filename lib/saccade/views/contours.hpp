// SPDX-License-Identifier: Apache-2.0
#pragma once
// contour_voxels, contour_points: empty voxels at the border of incomplete surfaces, and groups of them. LiveContours:
// contours of a map that keeps changing. contour_views: view poses that look at contours.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/angle.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/map/map_changes.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade {

/// Parameters of contours. Thesis §3.1.1.
struct ContourConfig {
  std::uint16_t known_weight{5};   ///< W_th: voxels observed less often count as unknown
  double group_distance_m{0.03};   ///< D_th: voxels of a group are nearer to its first one
  double group_angle_rad{30_deg};  ///< A_th: their normals are nearer to its normal

  /// Answers invalid_argument for a weight of zero, a distance that is not positive or an angle outside (0, 90°].
  [[nodiscard]] Status validate() const;
};

/// Empty voxel next to unknown space and near an occupied voxel. Its normal points towards known empty space.
struct ContourVoxel {
  Index3 voxel;
  Eigen::Vector3f normal{Eigen::Vector3f::Zero()};  ///< normal of the frontier (eq. 3.5), unit length
  [[nodiscard]] bool operator==(const ContourVoxel&) const = default;
};

/// Returns all contour voxels of a map. Thesis §3.1.1, eq. 3.2, 3.5, 3.6.
///
/// A voxel is known when the map's weights show known_weight observations or more. Where the map's free_weight is
/// smaller, only voxels within the truncation are ever known to be empty. Nothing outside the map's workspace is
/// unknown: a voxel there is no contour voxel, causes none, and enters a normal only if it is known. In eq. 3.6 free
/// space with a saturated weight counts W_th (docs/decisions/0009-contours.md). A voxel whose normal vanishes gives no
/// direction to look from, and is omitted.
/// @return by sector, brick and voxel, each in z-y-x order; invalid_argument for a bad config.
/// O(bricks near the surface + contour voxels). The thread count never changes a bit of the result.
[[nodiscard]] Result<std::vector<ContourVoxel>> contour_voxels(const TsdfSnapshot& map, const ContourConfig& config,
                                                               const Executor& executor);

/// Returns the contour voxels of these bricks, per sector; the sectors need not exist. Requires a valid configuration
/// (contract).
[[nodiscard]] std::vector<std::vector<ContourVoxel>> contour_voxels_in(const TsdfSnapshot& map,
                                                                       std::span<const SectorBricks> sectors,
                                                                       const ContourConfig& config,
                                                                       const Executor& executor);

/// Mean of a group of similar contour voxels.
struct ContourPoint {
  Eigen::Vector3d position_m{Eigen::Vector3d::Zero()};
  Eigen::Vector3d normal{Eigen::Vector3d::Zero()};  ///< unit length
  std::uint32_t voxels{0};                          ///< number of voxels in the group
  [[nodiscard]] bool operator==(const ContourPoint&) const = default;
};

/// Groups similar contour voxels into one point each. Thesis §3.1.1, eq. 3.7, whose second line is read as "the angle
/// between the normals is less than A_th": as printed, opposite normals would be alike.
///
/// The first ungrouped voxel starts a group and takes all ungrouped voxels that are similar to it. Similarity to the
/// first voxel bounds a group. If similar voxels were chained instead, one group would run along a whole edge, or
/// around a round object, and its mean would lie on neither. No group is wider than 2 D_th, no two of its normals
/// differ by 2 A_th, and their mean never vanishes (docs/decisions/0009-contours.md).
/// Groups are in the order of their first voxels. Requires a valid configuration and unit normals (contract). O(voxels
/// · groups within D_th of each). One thread.
[[nodiscard]] std::vector<ContourPoint> contour_points(std::span<const ContourVoxel> voxels, double voxel_size_m,
                                                       const ContourConfig& config);

/// Changes made by LiveContours::update.
struct ContoursUpdate {
  std::size_t bricks_changed{0};  ///< changed bricks of the map
  double ms{0.0};
};

/// Contours that follow a map from snapshot to snapshot. After update(map), voxels() equals contour_voxels(map) to the
/// bit. Thesis §3.1.1.
///
/// Whether a voxel belongs to a contour, and its normal, depend only on its neighbours. After a change, the contours of
/// changed bricks and their up to 26 neighbours are found anew; all others are kept. Const use from many threads is
/// safe, with one writer at a time. LiveContours holds the snapshot.
class LiveContours {
 public:
  /// Answers invalid_argument for an invalid configuration.
  [[nodiscard]] static Result<LiveContours> create(const ContourConfig& config = {});

  /// Brings the contours to this state of the map, later or earlier, or to another map; from scratch where the
  /// configurations of both maps differ. O(changed_sectors + bricks around changed ones). The thread count never
  /// changes the result.
  ContoursUpdate update(const TsdfSnapshot& map, const Executor& executor);

  /// Returns all contour voxels. O(voxels).
  [[nodiscard]] std::vector<ContourVoxel> voxels() const;
  /// Returns their groups, as contour_points does.
  [[nodiscard]] std::vector<ContourPoint> points() const;

 private:
  struct Sector {
    Index3 key;
    std::vector<ContourVoxel> voxels;  ///< sorted by brick and voxel
  };
  explicit LiveContours(const ContourConfig& config) : config_{config} {}
  void replace(const SectorBricks& stale, const std::vector<ContourVoxel>& fresh);

  ContourConfig config_;
  TsdfSnapshot map_;
  std::vector<Sector> sectors_;  ///< sectors with contour voxels, in z-y-x order
};

/// Sampling of views around the direction of a contour point. Thesis §3.1, Fig. 3.2; the defaults give 40 per point.
struct ContourViewConfig {
  std::vector<double> distances_m{0.8};
  double cone_rad{15_deg};  ///< tilt of the four further directions
  double roll_step_rad{45_deg};

  /// Answers invalid_argument for distances or a step that are not positive, a cone outside (0, 90°) or more than 10⁷
  /// poses.
  [[nodiscard]] Status validate() const;
  /// Returns five directions · rolls · distances. Requires a valid configuration.
  [[nodiscard]] std::size_t views_per_point() const;
};

/// Returns poses that look at each point along its normal, and from four directions tilted away from it. Thesis §3.1,
/// GetViewpoints of Algorithm 4. Direction 0 is the normal n: the camera stands at p + distance · n and looks along -n.
/// The others are tilted towards the right, the top, the left and the bottom of its image at roll 0. At roll 0 the
/// image's up is the world's, as in view_sphere; for a camera that looks straight up or down it is world +y. Roll turns
/// the camera about its optical axis.
/// Index order: ((point · distances + distance) · 5 + direction) · rolls + roll.
/// @return world ← camera; invalid_argument for a bad configuration, a point or normal that is not finite, a normal of
/// length zero, or more than 10⁷ poses.
[[nodiscard]] Result<std::vector<Pose>> contour_views(std::span<const ContourPoint> points,
                                                      const ContourViewConfig& config = {});

}  // namespace saccade
