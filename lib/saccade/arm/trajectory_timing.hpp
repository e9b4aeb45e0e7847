// SPDX-License-Identifier: Apache-2.0
#pragma once
// parametrise: a path of an arm with its times, within the limits of speed and acceleration.

#include <functional>

#include "saccade/arm/arm_model.hpp"
#include "saccade/arm/trajectory_timing.hpp"
#include "saccade/robot/trajectory.hpp"

namespace saccade {

/// Whether the arm is free all along a piece of a trajectory.
using PieceIsFree = std::function<bool(const Trajectory::Piece& piece)>;

/// On every straight line all joints start, cruise and brake together, the slowest at its limit. At an inner
/// configuration, where `is_free` says that a parabola which cuts the corner is free, the arm turns without stopping;
/// elsewhere, and with no `is_free`, it stops there. A parabola takes no more than half of the lines beside it, both
/// together are never slower than stopping. Configurations within 1e-12 of the one before are passed over. The last
/// configuration is met to rounding.
/// O(configurations) and as many calls of is_free, or a few times as many.
[[nodiscard]] Trajectory parametrise(const ArmModel& arm, const JointPath& path, const PieceIsFree& is_free = {});

/// Seconds of parametrise without is_free: every line from rest to rest. O(configurations)
[[nodiscard]] double rest_to_rest_s(const ArmModel& arm, const Configuration& from, const Configuration& to);
[[nodiscard]] double rest_to_rest_s(const ArmModel& arm, const JointPath& path);

}  // namespace saccade
