// SPDX-License-Identifier: Apache-2.0
#pragma once
// MeshDistance: distance of points from the nearest triangle. Solids: whether a point lies inside a body of a scene,
// and its distance from the bodies.

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/scene/ray_scene.hpp"

namespace saccade {

/// Distances to the surface of a mesh: to triangles, not vertices. Immutable, cheap to copy, safe for concurrent use.
class MeshDistance {
 public:
  /// Builds the search tree. Answers invalid_argument for a mesh without triangles or with indices out of range;
  /// unavailable when Embree does not start. O(triangles · log triangles).
  [[nodiscard]] static Result<MeshDistance> build(const TriangleMesh& mesh);

  /// Returns the distance to the nearest triangle, or `beyond_m` where none is nearer. Computed in double precision.
  [[nodiscard]] double distance_m(const Eigen::Vector3d& p, double beyond_m) const;
  /// Returns distance_m for each point. Points that follow one another closely cost less: the distance of one bounds
  /// that of the next. The thread count changes no bit.
  [[nodiscard]] std::vector<double> distances_m(std::span<const Eigen::Vector3f> points, double beyond_m,
                                                const Executor& executor) const;

 private:
  struct Impl;
  explicit MeshDistance(std::shared_ptr<const Impl> impl);
  std::shared_ptr<const Impl> impl_;
};

/// Joins the objects for which `wanted` holds to one mesh, world frame.
[[nodiscard]] TriangleMesh joined_mesh(const std::vector<ObjectMesh>& meshes,
                                       const std::function<bool(std::size_t object)>& wanted);

/// Closed bodies of a scene. Immutable, cheap to copy, safe for concurrent use.
class Solids {
 public:
  /// Builds the bodies for which `wanted` holds; there may be none. Errors: those of RayScene::build.
  [[nodiscard]] static Result<Solids> build(const RayScene& scene,
                                            const std::function<bool(const SceneObject&)>& wanted);

  /// Tells whether p lies inside a body. Tested body by body, since surfaces coincide where one stands on another.
  /// O(bodies · log triangles).
  [[nodiscard]] bool contain(const Eigen::Vector3d& p) const;
  /// Returns the distance to the nearest surface, or `beyond_m` where none is nearer.
  [[nodiscard]] double distance_m(const Eigen::Vector3d& p, double beyond_m) const;

 private:
  Solids(std::vector<RayScene> bodies, std::optional<MeshDistance> surface)
      : bodies_{std::move(bodies)}, surface_{std::move(surface)} {}
  std::vector<RayScene> bodies_;  // one per object
  std::optional<MeshDistance> surface_;
};

}  // namespace saccade
