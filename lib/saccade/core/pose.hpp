// SPDX-License-Identifier: Apache-2.0
#pragma once
// Pose: a rigid transform T_a_b that maps coordinates of frame b into frame a. Checked construction from matrices.

#include <Eigen/Geometry>

#include "saccade/core/result.hpp"

namespace saccade {

/// Rigid transform. Name every instance `T_a_b`: p_a = T_a_b * p_b. Metres.
using Pose = Eigen::Isometry3d;

/// Tolerance on ‖RRᵀ − I‖ (Frobenius norm) within which a matrix from a file is accepted as a rotation.
constexpr double kRotationTolerance{1e-3};

/// Makes a pose from a 4×4 matrix [R t; 0 0 0 1]. Accepts R when ‖RRᵀ − I‖ ≤ kRotationTolerance and det R > 0, and
/// replaces it by the nearest rotation. Answers invalid_argument for NaN, infinity, another last row, or R that is not
/// a rotation.
[[nodiscard]] Result<Pose> pose_from_matrix(const Eigen::Matrix4d& matrix);

/// Returns the pose of a camera at `position` whose optical axis (+z) points at `target`. Image up follows `up` as far
/// as possible; it is world +y where the axis is parallel to `up`. Roll turns the camera about its own axis.
[[nodiscard]] Pose look_at(const Eigen::Vector3d& position, const Eigen::Vector3d& target,
                           const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ(), double roll_rad = 0.0);

/// Returns the angle of the rotation part, in [0, π].
[[nodiscard]] double rotation_angle_rad(const Pose& T);

}  // namespace saccade
