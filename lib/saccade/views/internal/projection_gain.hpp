// SPDX-License-Identifier: Apache-2.0
#pragma once
// ProjectionGain: what projection_gain makes; frontier_pixels: the area of frontiers in an image.

#include "saccade/views/internal/baseline_scene.hpp"
#include "saccade/views/internal/ellipsoids.hpp"

namespace saccade {

/// Cells from which clusters of voxels start.
constexpr double kClusterCell_m{0.05};

/// Ellipsoids around the voxels that count.
struct SceneEllipsoids {
  std::vector<Ellipsoid> frontier;  ///< of unknown voxels next to an empty and to an occupied one
  std::vector<Ellipsoid> occupied;  ///< of surface voxels
};
/// O(voxels that count).
[[nodiscard]] SceneEllipsoids scene_ellipsoids(const BaselineScene& scene, const Executor& executor);

/// Pixels covered by a frontier's ellipsoid whose centre is nearer than those of all occupied ones that cover them.
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
