// SPDX-License-Identifier: Apache-2.0
#pragma once
// MeshDistance: how far points are from the nearest triangle; closest_point_on_triangle.

#include <memory>

#include "saccade/core/result.hpp"
#include "saccade/map/mesh.hpp"

namespace saccade {

/// The point of triangle abc (corners, edges and inside) nearest to p. A degenerate triangle is its longest edge.
[[nodiscard]] Eigen::Vector3d closest_point_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                                        const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Distances to the surface of a mesh; triangles, not vertices. Immutable, cheap to copy, safe for concurrent use.
class MeshDistance {
 public:
  /// invalid_argument for a mesh without triangles or with indices out of range; unavailable when Embree does not
  /// start. O(triangles · log triangles).
  [[nodiscard]] static Result<MeshDistance> build(const TriangleMesh& mesh);

  /// Distance to the nearest triangle, or `beyond_m` where none is nearer. Computed in double precision.
  [[nodiscard]] double distance_m(const Eigen::Vector3d& p, double beyond_m) const;

 private:
  struct Impl;
  explicit MeshDistance(std::shared_ptr<const Impl> impl);
  std::shared_ptr<const Impl> impl_;
};

}  // namespace saccade
