// SPDX-License-Identifier: Apache-2.0
#pragma once
// expected_surface: predicts the surface of objects in a map's unknown space: its position, area and orientation.

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
class ViewDevice;

struct ExpectedSurfaceConfig {
  /// Objects are completed down to their supports: level surfaces that were seen over at least this area.
  double min_support_m2{0.08};
  double min_wall_m2{0.16};  ///< Smallest seen area of a wall.
  /// Unknown space next to empty space counts up to this distance from the seen surface of an object, weighted by e^(−d
  /// / decay),
  double reach_m{0.10};
  double decay_m{0.05};
  double beside_share{0.16};  ///< and by this share of its area, since most of it turns out to be empty.
  /// The boundary of completed objects counts as this share of its area: part of it lies too far out, or is hidden for
  /// good.
  double completed_share{0.8};
  /// Additional share where unknown space closes a cavity: a hemisphere has twice the area of its opening.
  double behind_opening{2.0};
  /// Points closer together than this, with similar orientation, are merged.
  double spacing_m{0.015};
  /// A line of sight may begin with unknown space over this length, because completed surfaces are guesses.
  double through_m{0.12};

  /// Answers invalid_argument for areas and lengths that are not positive and finite, or shares outside [0, 1].
  [[nodiscard]] Status validate() const;
  [[nodiscard]] bool operator==(const ExpectedSurfaceConfig&) const = default;
};

/// Piece of surface that has not been seen.
struct ExpectedPoint {
  std::uint32_t voxel{0};    ///< unknown voxel at its centre: an index into ExpectedSurface::volume
  std::int32_t support{-1};  ///< index of the support below it; −1: none
  std::int32_t object{-1};   ///< index of the nearest object; −1: none is within reach
  Eigen::Vector3f position_m{Eigen::Vector3f::Zero()};
  Eigen::Vector3f normal{Eigen::Vector3f::UnitZ()};  ///< towards empty space, unit length
  float area_cm2{0.0F};                              ///< expected area
};

/// Expected surface in the map's workspace, or in its whole known space where it has none. Immutable; cheap to share.
struct ExpectedSurface {
  std::vector<ExpectedPoint> points;          ///< points of completed objects first, each kind by voxel layers
  std::size_t completed{0};                   ///< number of points of completed objects; the others lie beside seen
                                              ///< surface
  std::vector<Support> supports;              ///< the largest first
  std::vector<Wall> walls;                    ///< the largest first
  std::vector<Box> objects;                   ///< boxes around the seen voxels of each object, world frame
  double seen_cm2{0.0};                       ///< area of the objects' surface seen so far
  ExpectedSurfaceConfig config;               ///< parameters in use
  std::shared_ptr<const StateVolume> volume;  ///< the states of voxels

  /// Tells whether a camera may see a point, judged without testing the line between them: at most 80° from its normal,
  /// and past no support.
  [[nodiscard]] bool faces(const ExpectedPoint& point, const Eigen::Vector3d& camera_m) const;
  /// Tells whether a camera in some orientation sees a point: at most 80° from its normal, past no support, and along a
  /// line of known empty space.
  [[nodiscard]] bool is_visible(const ExpectedPoint& point, const Eigen::Vector3d& camera_m) const;
  /// Returns the index of the object whose box is nearest to a point, −1 where none is within a distance. Where boxes
  /// overlap, the one with the nearest middle. O(objects).
  [[nodiscard]] std::int32_t object_near(const Eigen::Vector3d& p_m, double within_m) const;
};

/// Predicts surface in two places. First, it completes each object (occupied voxels above the supports, connected
/// across gaps of at most two voxels). The footprint's convex hull is extruded from the object's support to its top,
/// minus known empty space; the boundary of the unknown space inside is expected to be surface, with more weight in
/// cavities. Second, unknown space next to empty space near the seen surface of an object counts with less weight.
/// @return an empty surface for a map without objects; invalid_argument for a bad config or too large a workspace.
/// O(voxels of the workspace). The thread count never changes a bit.
/// @param device reads the voxels' states and finds the exposed ones; nullptr, or an error of the device: the CPU does.
[[nodiscard]] Result<ExpectedSurface> expected_surface(const TsdfSnapshot& map, const ExpectedSurfaceConfig& config,
                                                       const Executor& executor, ViewDevice* device = nullptr);

/// Returns the expected surface of a context's map. Parts of one choice with equal configurations share it.
[[nodiscard]] Result<std::shared_ptr<const ExpectedSurface>> expected_surface(const PlanningContext& context,
                                                                              const ExpectedSurfaceConfig& config);

}  // namespace saccade
