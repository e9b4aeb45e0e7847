// SPDX-License-Identifier: Apache-2.0
#pragma once
// MeshDistance: how far points are from the nearest triangle.

#include <memory>

#include "saccade/core/result.hpp"
#include "saccade/map/mesh.hpp"

namespace saccade {

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
