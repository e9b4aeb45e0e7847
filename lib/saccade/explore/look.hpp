// SPDX-License-Identifier: Apache-2.0
#pragma once
// look: what happens at a view. The camera is tilted up and down, and what it sees is fused.

#include "saccade/explore/exploration.hpp"

namespace saccade {

/// The view tilted about the camera's x axis.
[[nodiscard]] Pose tilted(const Pose& T_world_view, double tilt_rad);

/// 0 where a view has but one frame, which is taken from the view itself.
[[nodiscard]] double oscillation_rad(const ExplorationConfig& config);

/// Tilts that are tried for one end of an oscillation, the farthest first: halves of halves.
[[nodiscard]] std::vector<double> tilts_towards(double farthest_rad);

/// Takes a picture where the camera is, and fuses it. Errors: those of camera and map.
[[nodiscard]] Status fuse_frame(TsdfMap& map, ExplorationCell& cell, const Pose& T_world_camera,
                                const Executor& executor);

/// What looking came to.
struct Look {
  std::size_t frames{0};
  Tilt tilt;
  double motion_s{0.0};
};

/// PerformRobotOscillation of Algorithm 1, about the camera's x axis: frames evenly from the least tilt that the robot
/// can take to the greatest, each one fused. Errors: those of robot, camera and map.
[[nodiscard]] Result<Look> look(TsdfMap& map, ExplorationCell& cell, const Pose& T_world_view,
                                const ExplorationConfig& config, const Executor& executor);

}  // namespace saccade
