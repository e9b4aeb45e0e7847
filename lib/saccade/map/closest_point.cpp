// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace saccade {

using Eigen::Vector3d;

namespace {

Vector3d closest_point_on_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d ab = b - a;
  const double length2 = ab.squaredNorm();
  return length2 > 0.0 ? Vector3d{a + std::clamp(ab.dot(p - a) / length2, 0.0, 1.0) * ab} : a;
}

}  // namespace

Vector3d closest_point_on_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  // The foot of p on the plane if it lies inside, otherwise the nearest point of the three edges.
  const Vector3d normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  if (area2 > 0.0) {
    const Vector3d foot = p - normal.dot(p - a) / area2 * normal;
    const bool inside = normal.dot((b - a).cross(foot - a)) >= 0.0 && normal.dot((c - b).cross(foot - b)) >= 0.0 &&
                        normal.dot((a - c).cross(foot - c)) >= 0.0;
    if (inside) return foot;
  }
  Vector3d nearest = closest_point_on_segment(p, a, b);
  for (const Vector3d& candidate : {closest_point_on_segment(p, b, c), closest_point_on_segment(p, c, a)}) {
    if ((candidate - p).squaredNorm() < (nearest - p).squaredNorm()) nearest = candidate;
  }
  return nearest;
}

}  // namespace saccade
