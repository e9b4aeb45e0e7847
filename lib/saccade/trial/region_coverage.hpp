// SPDX-License-Identifier: Apache-2.0
#pragma once
// RegionCoverage: how much of what can be seen in a region a mesh has, supports included. Definitions: docs/metrics.md.

#include <cstddef>
#include <optional>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/region.hpp"
#include "saccade/scene/mesh_distance.hpp"
#include "saccade/scene/ray_scene.hpp"

namespace saccade {

/// What can be seen of the true surfaces in a region and the workspace.
struct RegionSurface {
  std::vector<Eigen::Vector3f> of_objects;
  std::vector<Eigen::Vector3f> of_supports;
};

/// Samples the true surfaces as Truth::build does, and finds out which points in the region can be seen at all; there
/// may be none. invalid_argument for a spacing that is not positive or a bad region. Cost: observable() for the points
/// in the region.
[[nodiscard]] Result<RegionSurface> observable_in(const RayScene& scene, const Region& region, double spacing_m,
                                                  const Executor& executor);

/// Shares of observable points that the mesh has within a distance; nullopt where there are no such points.
struct RegionCoverage {
  std::optional<double> objects;   ///< supports left out
  std::optional<double> surfaces;  ///< of objects and supports together
};

/// Holds a mesh against the surface in a region; one without triangles has nothing of it. Expects indices within range
/// and a positive distance. O(triangles · log triangles + points · log triangles), the same for every thread count.
[[nodiscard]] RegionCoverage measure_coverage(const RegionSurface& truth, const TriangleMesh& mesh, double within_m,
                                              const Executor& executor);
/// The same for several regions: the distance to the mesh is built once. Null: it has no triangles.
[[nodiscard]] RegionCoverage measure_coverage(const RegionSurface& truth, const MeshDistance* mesh, double within_m,
                                              const Executor& executor);

}  // namespace saccade
