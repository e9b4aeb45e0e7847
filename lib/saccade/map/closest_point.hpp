// SPDX-License-Identifier: Apache-2.0
#pragma once
// closest_point_on_triangle.

#include <Eigen/Core>

namespace saccade {

/// The point of triangle abc (corners, edges and inside) nearest to p. A degenerate triangle is its longest edge.
[[nodiscard]] Eigen::Vector3d closest_point_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                                        const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace saccade
