// SPDX-License-Identifier: Apache-2.0
#pragma once
// turned and bent_bar: closed meshes from outlines, the parts of procedural shapes.

#include <Eigen/Core>
#include <vector>

#include "saccade/map/mesh.hpp"

namespace saccade {

/// Returns the number of sides of a regular polygon that deviates from its circle by at most max_deviation_m; 8 to
/// 1024.
[[nodiscard]] int sides_of_circle(double radius_m, double max_deviation_m);

/// Returns the radius of a profile of (radius, height) points at a height; beyond its ends that of the lowest or
/// highest point.
[[nodiscard]] double profile_radius_m(const std::vector<Eigen::Vector2d>& profile_m, double height_m);

/// Revolves an outline of (radius, height) points around the z axis. The mesh is closed where the outline starts and
/// ends on the axis, and outward where it goes up on the outside. Vertices follow the outline, `sides` per point, one
/// for a point on the axis.
[[nodiscard]] TriangleMesh turned(const std::vector<Eigen::Vector2d>& outline_m, int sides);

/// Makes a round bar along an axis of (x, z) points in the plane y = 0, closed by flat ends.
[[nodiscard]] TriangleMesh bent_bar(const std::vector<Eigen::Vector2d>& axis_m, double radius_m, int sides);

}  // namespace saccade
