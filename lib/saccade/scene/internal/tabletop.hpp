// SPDX-License-Identifier: Apache-2.0
#pragma once
// empty_tabletop: the cell in which random and given objects are put.

#include <string>

#include "saccade/scene/scene.hpp"

namespace saccade {

/// A table of 1.2 × 0.8 m with its top at z = 0 in a room of 6 × 6 m, nothing on it: the workspace reaches 0.40 m above
/// the table, and the initial scan looks along it from its left end. For random_clutter and mesh_scene.
[[nodiscard]] Scene empty_tabletop(std::string name);

}  // namespace saccade
