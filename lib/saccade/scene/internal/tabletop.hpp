// SPDX-License-Identifier: Apache-2.0
#pragma once
// empty_tabletop: the cell that random and given objects are placed in.

#include <string>

#include "saccade/scene/scene.hpp"

namespace saccade {

/// Returns a table of 1.2 × 0.8 m with its top at z = 0 in a room of 6 × 6 m, with nothing on it. The workspace reaches
/// 0.40 m above the table; the initial scan looks along it from its left end. For random_clutter and mesh_scene.
[[nodiscard]] Scene empty_tabletop(std::string name);

}  // namespace saccade
