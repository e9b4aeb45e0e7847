// SPDX-License-Identifier: Apache-2.0
#pragma once
// arm_mesh: an arm's bodies in a configuration as one mesh, for pictures.

#include "saccade/arm/kinematics.hpp"

namespace saccade {

/// The bodies of all links as triangles (body_surface) in the world's frame: two greys in turn from link to link, and
/// `hand` for the last link, which carries the camera. Vertices are not shared between bodies; normals are empty.
/// q must have one value per joint (a contract). O(triangles).
[[nodiscard]] TriangleMesh arm_mesh(const ArmModel& arm, const Configuration& q, const Rgb8& hand = {222, 132, 38});

}  // namespace saccade
