// SPDX-License-Identifier: Apache-2.0
#pragma once
// Forward kinematics and the geometric Jacobian of an ArmModel.

#include <Eigen/Core>
#include <array>

#include "saccade/arm/arm_model.hpp"

namespace saccade {

/// Poses of all links and of the camera. Entries beyond dof() are not set.
struct ArmPoses {
  std::array<Pose, kMaxJoints + 1> T_world_link;  ///< base first
  Pose T_world_camera;
};

/// Rows 0–2: velocity of the camera's centre, m/s; rows 3–5: angular velocity, rad/s; both in the world frame. One
/// column per joint speed.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMaxJoints>;

/// Returns the rotation by angle_rad about a unit axis (Rodrigues' formula).
[[nodiscard]] Eigen::Matrix3d rotation_about(const Eigen::Vector3d& axis, double angle_rad);

// q must have one value per joint (a contract); limits are ignored. Nothing is allocated. O(joints).

/// Return the poses of all links and of the camera, or the camera's alone.
[[nodiscard]] ArmPoses forward_kinematics(const ArmModel& arm, const Configuration& q);
[[nodiscard]] Pose camera_pose(const ArmModel& arm, const Configuration& q);
/// Returns the Jacobian: column i is (a × (p − o), a) for a joint that turns about the axis a through o, (a, 0) for a
/// joint that moves along a.
[[nodiscard]] Jacobian camera_jacobian(const ArmModel& arm, const Configuration& q);
/// Computes the Jacobian from poses that are known already.
[[nodiscard]] Jacobian camera_jacobian(const ArmModel& arm, const ArmPoses& poses);

/// Returns the difference of two poses as a twist in their common frame: translation in metres, then the rotation
/// vector that turns a into b, rad.
[[nodiscard]] Eigen::Matrix<double, 6, 1> twist_between(const Pose& T_world_a, const Pose& T_world_b);

/// Returns an upper bound of the distance between the first joint's origin and the camera's centre: the links stretched
/// out.
[[nodiscard]] double reach_bound_m(const ArmModel& arm);

}  // namespace saccade
