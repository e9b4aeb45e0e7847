// SPDX-License-Identifier: Apache-2.0
#pragma once
// arm_hash: tells whether two arms are the same to a planner.

#include <string>

#include "saccade/arm/arm_model.hpp"

namespace saccade {

/// 16 hexadecimal digits from all that changes how an arm moves and what it touches: joints, limits, mounts and
/// bodies. Names do not. Fnv1a. O(vertices).
[[nodiscard]] std::string arm_hash(const ArmModel& arm);

}  // namespace saccade
