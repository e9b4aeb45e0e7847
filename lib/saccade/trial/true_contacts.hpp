// SPDX-License-Identifier: Apache-2.0
#pragma once
// count_contacts: whether an arm touched what is really there, which it does not know when it plans.

#include <span>

#include "saccade/arm/arm_collision.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/robot/trajectory.hpp"
#include "saccade/scene/solids.hpp"

namespace saccade {

/// Instants of the motions, one every step_s, at which a link cuts into a solid. The links are taken as their balls of
/// ArmCollision, the finest of them 5 mm smaller, as they may exceed the links by that.
/// O(instants · balls near something · log triangles)
[[nodiscard]] std::size_t count_contacts(const ArmCollision& collision, const Solids& solids,
                                         std::span<const Trajectory> motions, const Executor& executor,
                                         double step_s = 0.03);

}  // namespace saccade
