// SPDX-License-Identifier: Apache-2.0
#pragma once
// convex_cover: a closed convex surface around points, for meshes that may be open or have many triangles.

#include <Eigen/Core>
#include <span>

#include "saccade/map/mesh.hpp"

namespace saccade {

/// Returns a closed convex surface of at most about 500 triangles that encloses the points and exceeds their convex
/// hull by a few per cent of its size; around flat or coincident points, a box with sides of at least 1 mm. Expects at
/// least one point, all finite. Deterministic. O(points).
[[nodiscard]] TriangleMesh convex_cover(std::span<const Eigen::Vector3f> points);

}  // namespace saccade
