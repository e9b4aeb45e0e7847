// SPDX-License-Identifier: Apache-2.0
#pragma once
// solve_mount: AX = XB for the mount X of a camera on a flange. turns_of: the axes about which a flange turned.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "saccade/core/pose.hpp"

namespace saccade {

/// One motion measured twice: A X = X B.
struct MotionPair {
  Pose T_flange_flange{Pose::Identity()};  ///< A
  Pose T_camera_camera{Pose::Identity()};  ///< B
};

/// Adds the motions between each two of the poses; of more than 60 poses, 60 are used. Expects equally many of both.
void add_motions(std::span<const Pose> T_base_flange, std::span<const Pose> T_world_camera,
                 std::vector<MotionPair>& motions);

/// Turns between each two poses, as rotation vectors in the flange's frame.
struct Turns {
  Eigen::Vector3d rms_rad{Eigen::Vector3d::Zero()};          ///< about three axes, the largest first
  Eigen::Matrix3d axes_flange{Eigen::Matrix3d::Identity()};  ///< column by column
};
[[nodiscard]] Turns turns_of(std::span<const Pose> T_base_flange);

/// Solves for the rotation first (Park and Martin 1994: the rotation from the camera's rotation vectors to the
/// flange's), then for the translation by least squares; both reweighted by Tukey's function. nullopt without motions
/// that turn by more than 3° about two axes, or where the motions contradict each other.
[[nodiscard]] std::optional<Pose> solve_mount(std::span<const MotionPair> motions);

}  // namespace saccade
