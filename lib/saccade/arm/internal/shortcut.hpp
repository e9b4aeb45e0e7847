// SPDX-License-Identifier: Apache-2.0
#pragma once
// shortcut: shortens a path that a search found, wherever that saves time.

#include <cstdint>
#include <functional>

#include "saccade/arm/motion_planner.hpp"

namespace saccade {

/// Leaves out configurations, then connects random points of the path by chords, until `tries` chords in a row have
/// saved nothing. Time is that of rest_to_rest_s. The ends stay. Each call of motion_is_free checks one straight line;
/// lines of the path are taken to be free. A seed gives one path.
[[nodiscard]] JointPath shortcut(
    const ArmModel& arm, JointPath path,
    const std::function<bool(const Configuration& from, const Configuration& to)>& motion_is_free, int tries,
    std::uint64_t seed);

}  // namespace saccade
