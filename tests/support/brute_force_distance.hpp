// SPDX-License-Identifier: Apache-2.0
#pragma once
// brute_force_distance_m: the distance to a mesh by looking at every triangle; the reference for fast searches.

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "saccade/map/mesh.hpp"

namespace saccade::test {

/// Minimum of |a + s·ab + t·ac − p| over s, t ≥ 0, s + t ≤ 1: the free minimum if it is allowed, else that of the
/// borders.
inline double brute_force_distance_m(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                     const Eigen::Vector3d& c) {
  const auto on_border = [&p](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const Eigen::Vector3d along = to - from;
    const double s = along.squaredNorm() > 0.0 ? along.dot(p - from) / along.squaredNorm() : 0.0;
    return (from + std::clamp(s, 0.0, 1.0) * along - p).norm();
  };
  Eigen::Matrix<double, 3, 2> sides;
  sides << b - a, c - a;
  const Eigen::Matrix2d normal = sides.transpose() * sides;
  if (normal.determinant() > 0.0) {
    const Eigen::Vector2d st = normal.inverse() * (sides.transpose() * (p - a));
    if (st.minCoeff() >= 0.0 && st.sum() <= 1.0) return (a + sides * st - p).norm();
  }
  return std::min({on_border(a, b), on_border(b, c), on_border(c, a)});
}

inline double brute_force_distance_m(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles) {
    nearest =
        std::min(nearest, brute_force_distance_m(p, mesh.vertices[a].cast<double>(), mesh.vertices[b].cast<double>(),
                                                 mesh.vertices[c].cast<double>()));
  }
  return nearest;
}

}  // namespace saccade::test
