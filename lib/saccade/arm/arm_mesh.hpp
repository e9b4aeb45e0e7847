// SPDX-License-Identifier: Apache-2.0
#pragma once
// body_surface: a collision body as triangles. arm_mesh: an arm's bodies in a configuration as one mesh, for pictures.

#include "saccade/arm/arm_model.hpp"
#include "saccade/arm/kinematics.hpp"

namespace saccade {

/// Returns the closed surface of a primitive, or a mesh unchanged, in the link's frame. Round surfaces are approximated
/// from outside: the mesh encloses the body and exceeds its radius by less than 1 % (spheres, 2 %). Normals and colours
/// are empty.
[[nodiscard]] TriangleMesh body_surface(const CollisionBody& body);

/// Returns the bodies of all links as triangles (body_surface) in the world's frame: alternating greys from link to
/// link, and `hand` for the last link, which carries the camera. Vertices are not shared between bodies; normals are
/// empty. q must have one value per joint (a contract). O(triangles).
[[nodiscard]] TriangleMesh arm_mesh(const ArmModel& arm, const Configuration& q, const Rgb8& hand = {222, 132, 38});

}  // namespace saccade
