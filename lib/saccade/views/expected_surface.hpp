// SPDX-License-Identifier: Apache-2.0
#pragma once
// expected_surface: where a map's unknown space is expected to hold surface of objects, how much, and facing where.

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "saccade/attention/attention_source.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/views/supports.hpp"

namespace saccade {

class StateVolume;

struct ExpectedSurfaceConfig {
  /// Objects are completed down to what they stand on: level surfaces that were seen over at least this area.
  double min_support_m2{0.08};
  double min_wall_m2{0.16};  ///< Least seen area of a wall.
  /// Unknown space beside empty space counts up to this distance from the seen surface of an object, by e^(−d / decay),
  double reach_m{0.10};
  double decay_m{0.05};
  double beside_share{0.16};  ///< as this share of its area: most of it turns out to be empty.
  /// The boundary of completed objects counts as this share of its area: it lies too far out, or was not seen for good.
  double completed_share{0.8};
  /// Where the unknown closes a cavity, there is this much more: a hemisphere has twice the area of its opening.
  double behind_opening{2.0};
  /// Points nearer to each other than this, facing about the same way, become one.
  double spacing_m{0.015};
  /// A line of sight may begin with unknown space over this length: completed surfaces are guesses.
  double through_m{0.12};

  /// invalid_argument for areas and lengths that are not positive and finite, or shares outside [0, 1].
  [[nodiscard]] Status validate() const;
  [[nodiscard]] bool operator==(const ExpectedSurfaceConfig&) const = default;
};

/// A piece of surface that was not seen yet.
struct ExpectedPoint {
  std::uint32_t voxel{0};    ///< unknown voxel at its centre: an index into ExpectedSurface::volume
  std::int32_t support{-1};  ///< index of the support below it; −1: none
  std::int32_t object{-1};   ///< index of the nearest object; −1: none is within reach
  Eigen::Vector3f position_m{Eigen::Vector3f::Zero()};
  Eigen::Vector3f normal{Eigen::Vector3f::UnitZ()};  ///< towards empty space, of length 1
  float area_cm2{0.0F};                              ///< expected
};

/// Parts of the map's workspace; its whole known space where it has none. Immutable; cheap to share.
struct ExpectedSurface {
  std::vector<ExpectedPoint> points;          ///< those of completed objects first, each kind by voxel layers
  std::size_t completed{0};                   ///< points of completed objects; the others lie beside what was seen
  std::vector<Support> supports;              ///< the largest first
  std::vector<Wall> walls;                    ///< the largest first
  std::vector<Box> objects;                   ///< around the seen voxels of each object, world frame
  double seen_cm2{0.0};                       ///< area of the surface of objects that was seen
  ExpectedSurfaceConfig config;               ///< that it was made with
  std::shared_ptr<const StateVolume> volume;  ///< the states of voxels

  /// Whether a point may be seen from a camera, as far as that can be told without a look between them: at most 80°
  /// from its normal, and past no support.
  [[nodiscard]] bool faces(const ExpectedPoint& point, const Eigen::Vector3d& camera_m) const;
  /// Whether a camera sees a point, however it is turned: at most 80° from its normal, past no support, and along a
  /// line of known empty space.
  [[nodiscard]] bool is_visible(const ExpectedPoint& point, const Eigen::Vector3d& camera_m) const;
  /// Index of the object whose box is nearest to a place, −1 where none is within a distance; where boxes overlap, of
  /// the one whose middle is nearest. O(objects).
  [[nodiscard]] std::int32_t object_near(const Eigen::Vector3d& p_m, double within_m) const;
};

/// Expects surface in two places. Each object (occupied voxels above the supports, connected by gaps of two voxels at
/// most) is completed: its footprint's convex hull is extruded from its support to its top, less what is known to be
/// empty, and the boundary of what is unknown in there is expected to be surface, of cavities more. So is, with less
/// weight, the unknown beside the empty near the seen surface of an object.
/// @return an empty surface for a map without objects; invalid_argument for a bad config or too large a workspace.
/// O(voxels of the workspace). The thread count never changes a bit.
[[nodiscard]] Result<ExpectedSurface> expected_surface(const TsdfSnapshot& map, const ExpectedSurfaceConfig& config,
                                                       const Executor& executor);

/// What is expected in a context's map. Parts of one choice that ask with equal configurations share it.
[[nodiscard]] Result<std::shared_ptr<const ExpectedSurface>> expected_surface(const PlanningContext& context,
                                                                              const ExpectedSurfaceConfig& config);

}  // namespace saccade
