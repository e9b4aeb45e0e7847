// SPDX-License-Identifier: Apache-2.0
#pragma once
// scene_hash: tells whether two scenes are the same to a depth camera.

#include <string>

#include "saccade/scene/ray_scene.hpp"

namespace saccade {

/// 16 hexadecimal digits from all that changes an exploration of the scene and its measurement: triangles, which
/// objects are supports or fixtures, workspace, regions, and the poses of the initial scan. Names, colours and textures
/// do not. A 64-bit FNV-1a hash: against mistakes, not against forgers. O(triangles).
[[nodiscard]] std::string scene_hash(const RayScene& scene);

}  // namespace saccade
