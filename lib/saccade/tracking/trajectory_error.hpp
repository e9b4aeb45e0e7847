// SPDX-License-Identifier: Apache-2.0
#pragma once
// TrajectoryError and trajectory_error: a tracked trajectory against the true one.

#include <cstddef>
#include <span>

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// Distances between camera positions, metres.
struct TrajectoryError {
  std::size_t poses{0};
  double first_pose_rmse_m{0.0};  ///< both trajectories joined at their first pose: contains all drift
  double aligned_rmse_m{0.0};     ///< after the rigid motion (no scale) that makes it smallest
  double max_m{0.0};              ///< largest distance after the same rigid motion
};

/// Compares pose i of one trajectory with pose i of the other; the absolute trajectory error of Sturm et al. (IROS
/// 2012), aligned as in Umeyama (PAMI 1991) without scale. Either trajectory may have its own world frame.
/// @return invalid_argument for no poses, size_mismatch for different numbers of poses. O(n), one thread.
[[nodiscard]] Result<TrajectoryError> trajectory_error(std::span<const Pose> T_world_estimated,
                                                       std::span<const Pose> T_world_true);

}  // namespace saccade
