// SPDX-License-Identifier: Apache-2.0
#pragma once
// random_clutter: scenes drawn from a seed.

#include <cstdint>

#include "saccade/scene/scene.hpp"

namespace saccade {

/// Bodies of every procedural kind, standing apart on a table of 1.2 × 0.8 m with its top at z = 0 in a room, and an
/// initial scan from one side of the table. 1 ≤ objects ≤ 16; fewer are placed when the table is full. The same on
/// every machine.
[[nodiscard]] Scene random_clutter(std::uint64_t seed, int objects = 8);

}  // namespace saccade
