// SPDX-License-Identifier: Apache-2.0
#pragma once
// body_surface: a collision body as triangles.

#include "saccade/arm/arm_model.hpp"

namespace saccade {

/// Closed surfaces of primitives, and meshes as they are, in the link's frame. What is round becomes flat on the
/// outside: the surface lies around the body and exceeds its radius by less than 1 % (spheres, 2 %). Normals and
/// colours are empty.
[[nodiscard]] TriangleMesh body_surface(const CollisionBody& body);

}  // namespace saccade
