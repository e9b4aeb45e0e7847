// SPDX-License-Identifier: Apache-2.0
#pragma once
// ProjectionGain: the result of projection_gain. frontier_pixels: the area of frontiers in an image.

#include "saccade/views/internal/baseline_scene.hpp"
#include "saccade/views/internal/ellipsoids.hpp"

namespace saccade {

/// Cell size from which clusters of voxels start.
constexpr double kClusterCell_m{0.03};
constexpr double kOccludedWeight{0.5};  ///< ellipsoids are coarse: a covered one may still be visible

/// Ellipsoids around the counted voxels.
struct SceneEllipsoids {
  std::vector<Ellipsoid> frontier;  ///< around unknown voxels next to an empty and to an occupied one
  std::vector<Ellipsoid> occupied;  ///< around surface voxels
};
/// Fits the ellipsoids. O(counted voxels).
[[nodiscard]] SceneEllipsoids scene_ellipsoids(const BaselineScene& scene, const Executor& executor);

/// Counts the pixels covered by a frontier's ellipsoid, each reduced by the factor kOccludedWeight for every occupied
/// ellipsoid that covers it too and whose centre is nearer.
[[nodiscard]] double frontier_pixels(const SceneEllipsoids& ellipsoids, const Pose& T_world_camera,
                                     const PinholeCamera& camera);

class ProjectionGain final : public Gain {
 public:
  /// Expects a valid configuration.
  explicit ProjectionGain(const BaselineGainConfig& config);
  [[nodiscard]] Result<std::vector<double>> evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> T_world_camera) override;

 private:
  BaselineGainConfig config_;
  PinholeCamera camera_;
};

}  // namespace saccade
