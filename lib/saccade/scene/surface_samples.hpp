// SPDX-License-Identifier: Apache-2.0
#pragma once
// Points spread over the true surfaces of a scene, and which of them any camera could see at all.

#include <optional>
#include <vector>

#include "saccade/scene/ray_scene.hpp"

namespace saccade {

/// Points on triangles, world frame; all arrays have the same length.
struct SurfaceSamples {
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals;  ///< outward
  std::vector<std::uint32_t> objects;    ///< index into Scene::objects
};

/// About one point per spacing_m², spread evenly over the area of each mesh, in the order of its triangles; only points
/// in the box, where one is given. Expects a positive spacing. The same on every machine.
[[nodiscard]] SurfaceSamples sample_surfaces(const std::vector<ObjectMesh>& meshes, double spacing_m,
                                             const std::optional<Box>& within = {});

struct ObservabilityConfig {
  int positions{800};                ///< of a free camera, evenly over a half sphere
  double clearance_m{0.4};           ///< of that half sphere, from the ball around the workspace
  double max_incidence_rad{1.3963};  ///< 80°: flatter views bring no return
};

/// For each sample, whether a camera at one or more of the positions, turned as it likes, would see it: nothing in
/// between, from outside, not too flat. The half sphere stands on the horizontal plane through the workspace's floor,
/// so what faces the support or is enclosed is not observable. O(samples · positions · log triangles).
[[nodiscard]] std::vector<std::uint8_t> observable(const RayScene& scene, const SurfaceSamples& samples,
                                                   const ObservabilityConfig& config, const Executor& executor);

}  // namespace saccade
