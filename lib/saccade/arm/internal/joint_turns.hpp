// SPDX-License-Identifier: Apache-2.0
#pragma once
// Whole turns: which of the angles that differ by 2π lie within a joint's limits.

#include <vector>

#include "saccade/arm/arm_model.hpp"

namespace saccade {

/// A solution may lie this far beyond a limit by rounding; it is then put on the limit. rad, or m.
constexpr double kLimitSlack{1e-10};

/// Whether angle + 2πk is within [lower, upper] for a whole k.
[[nodiscard]] bool has_turn_within(double angle_rad, double lower_rad, double upper_rad);

/// Appends q in every way that whole turns of its joints leave within the limits: for each joint at most `max_turns`
/// ways, those nearest to the reference, nearest first; for continuous joints one; for prismatic ones q itself, if it
/// is within. Order: the last joint changes fastest. Appends nothing where some joint has no way.
void append_turns(const ArmModel& arm, const Configuration& q, const Configuration& reference, int max_turns,
                  std::vector<Configuration>& solutions);

}  // namespace saccade
