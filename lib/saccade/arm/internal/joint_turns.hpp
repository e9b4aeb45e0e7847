// SPDX-License-Identifier: Apache-2.0
#pragma once
// Whole turns: the angles that differ by 2π and lie within a joint's limits.

#include <vector>

#include "saccade/arm/arm_model.hpp"

namespace saccade {

/// Distance beyond a limit that counts as rounding; the solution is then set to the limit. rad, or m.
constexpr double kLimitSlack{1e-10};

/// Tells whether angle + 2πk is within [lower, upper] for an integer k.
[[nodiscard]] bool has_turn_within(double angle_rad, double lower_rad, double upper_rad);

/// Appends q in every variant by whole turns of its joints within the limits: for each joint at most `max_turns`,
/// nearest to the reference first; for continuous joints one; for prismatic ones q itself, if it is within. The last
/// joint changes fastest. Appends nothing where a joint has no variant.
void append_turns(const ArmModel& arm, const Configuration& q, const Configuration& reference, int max_turns,
                  std::vector<Configuration>& solutions);

}  // namespace saccade
