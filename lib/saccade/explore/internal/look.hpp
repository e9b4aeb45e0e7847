// SPDX-License-Identifier: Apache-2.0
#pragma once
// Tilts of the camera at a view: PerformRobotOscillation of Algorithm 1.

#include <vector>

#include "saccade/explore/explorer.hpp"

namespace saccade {

/// The view tilted about the camera's x axis.
[[nodiscard]] Pose tilted(const Pose& T_world_view, double tilt_rad);

/// Tilt at the ends of an oscillation; 0 where a view has but one frame, which is taken from the view itself.
[[nodiscard]] double oscillation_rad(const ExplorerConfig& config);

/// Tilts that are tried for one end of an oscillation, the farthest first: halves of halves.
[[nodiscard]] std::vector<double> tilts_towards(double farthest_rad);

}  // namespace saccade
