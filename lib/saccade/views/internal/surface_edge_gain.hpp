// SPDX-License-Identifier: Apache-2.0
#pragma once
// FrontierPoint, frontier_points: points where observed surface ends beside unknown space. SurfaceEdgeGain counts them.

#include "saccade/views/internal/baseline_scene.hpp"

namespace saccade {

/// Radius of the neighbourhood for the surface density at a voxel, and the smallest density of core voxels relative to
/// a plane: 0.5 at the edge of a plane, 0.75 at the corner of a box.
constexpr double kDensityRadius_vox{4.0};
constexpr double kCoreDensity{0.7};
/// Cosine of the largest angle between the line of sight and the direction in which a frontier faces.
constexpr double kFrontierCosine{0.5};

/// Observed surface voxel at which the surface may continue.
struct FrontierPoint {
  std::uint32_t voxel{0};    ///< the surface voxel
  std::uint32_t unknown{0};  ///< nearest unknown voxel with an empty one beside a face, which a view must reach
  /// Unit bisector of the surface's normal and the direction in which the surface ends.
  Eigen::Vector3f facing{Eigen::Vector3f::UnitZ()};
};
/// Returns the points in the order of their voxels. O(surface voxels · voxels within the radius). The thread count
/// never changes a bit.
[[nodiscard]] std::vector<FrontierPoint> frontier_points(const BaselineScene& scene, const Executor& executor);

class SurfaceEdgeGain final : public Gain {
 public:
  /// Expects a valid configuration.
  explicit SurfaceEdgeGain(const BaselineGainConfig& config);
  [[nodiscard]] Result<std::vector<double>> evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> T_world_camera) override;

 private:
  BaselineGainConfig config_;
  PinholeCamera camera_;
};

}  // namespace saccade
