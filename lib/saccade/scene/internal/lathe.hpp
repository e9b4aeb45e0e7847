// SPDX-License-Identifier: Apache-2.0
#pragma once
// turned and bent_bar: closed meshes from outlines; what the procedural shapes are made with.

#include <Eigen/Core>
#include <vector>

#include "saccade/map/mesh.hpp"

namespace saccade {

/// Sides of a regular polygon in a circle that leaves it by at most max_deviation_m; 8 to 1024.
[[nodiscard]] int sides_of_circle(double radius_m, double max_deviation_m);

/// Radius of a profile of (radius, height) points at a height; the lowest or highest point's beyond its ends.
[[nodiscard]] double profile_radius_m(const std::vector<Eigen::Vector2d>& profile_m, double height_m);

/// An outline of (radius, height) points turned around the z axis: closed where the outline starts and ends on the
/// axis, outward where it goes up on the outside. Vertices go along the outline, `sides` per point, one for a point on
/// the axis.
[[nodiscard]] TriangleMesh turned(const std::vector<Eigen::Vector2d>& outline_m, int sides);

/// A round bar along an axis of (x, z) points in the plane y = 0, closed by flat ends across it.
[[nodiscard]] TriangleMesh bent_bar(const std::vector<Eigen::Vector2d>& axis_m, double radius_m, int sides);

}  // namespace saccade
