// SPDX-License-Identifier: Apache-2.0
#pragma once
// convex_hull: the corners of the smallest convex polygon around points of a plane.

#include <Eigen/Core>
#include <vector>

namespace saccade {

/// Returns the corners of the convex hull, counter-clockwise with y up; fewer than three where the points lie on a
/// line. O(points · log points).
[[nodiscard]] std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points);

}  // namespace saccade
