// SPDX-License-Identifier: Apache-2.0
#pragma once
// Points spread over the true surfaces of a scene, and whether any camera could see them.

#include <optional>
#include <vector>

#include "saccade/core/progress.hpp"
#include "saccade/scene/ray_scene.hpp"

namespace saccade {

/// Points on triangles, world frame; all arrays have the same length.
struct SurfaceSamples {
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals;  ///< outward
  std::vector<std::uint32_t> objects;    ///< index into Scene::objects
};

/// Returns the area of the triangles whose bounds meet the box, or of all.
[[nodiscard]] double surface_area_m2(const std::vector<ObjectMesh>& meshes, const std::optional<Box>& within = {});

/// Samples about one point per spacing_m², spread evenly over the area of each mesh, in the order of its triangles;
/// only points in the box, where one is given. Expects a positive spacing. Equal on every machine.
[[nodiscard]] SurfaceSamples sample_surfaces(const std::vector<ObjectMesh>& meshes, double spacing_m,
                                             const std::optional<Box>& within = {});

struct ObservabilityConfig {
  int positions{800};                ///< positions of a free camera, evenly spread over a half sphere
  double clearance_m{0.4};           ///< distance of the half sphere from the ball around the workspace
  double max_incidence_rad{1.3963};  ///< 80°: flatter views give no return
};

/// Tells for each sample whether a camera at one or more of the positions, in any orientation, would see it:
/// unobstructed, from outside, not too flat. The half sphere stands on the horizontal plane through the workspace's
/// floor, so surfaces that face the support or are enclosed are not observable. O(samples · positions · log triangles).
/// Once progress is cancelled the rest counts as not seen.
[[nodiscard]] std::vector<std::uint8_t> observable(const RayScene& scene, const SurfaceSamples& samples,
                                                   const ObservabilityConfig& config, const Executor& executor,
                                                   const Progress& progress = {});

}  // namespace saccade
