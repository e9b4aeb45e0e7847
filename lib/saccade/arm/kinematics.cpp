// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/kinematics.hpp"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

/// Returns the frame of the link behind a joint.
Pose link_pose(const Pose& T_world_parent, const ArmJoint& joint, double q) {
  Pose T_world_link;
  T_world_link.linear().noalias() = T_world_parent.linear() * joint.T_parent_joint.linear();
  T_world_link.translation().noalias() =
      T_world_parent.translation() + T_world_parent.linear() * joint.T_parent_joint.translation();
  if (joint.kind == JointKind::prismatic) {
    T_world_link.translation() += q * (T_world_link.linear() * joint.axis_joint);
  } else {
    T_world_link.linear() = (T_world_link.linear() * rotation_about(joint.axis_joint, q)).eval();
  }
  return T_world_link;
}

}  // namespace

Eigen::Matrix3d rotation_about(const Eigen::Vector3d& axis, double angle_rad) {
  const double s = std::sin(angle_rad);
  const double c = std::cos(angle_rad);
  const Eigen::Vector3d t = (1.0 - c) * axis;
  Eigen::Matrix3d R;
  R << t.x() * axis.x() + c, t.x() * axis.y() - s * axis.z(), t.x() * axis.z() + s * axis.y(),
      t.y() * axis.x() + s * axis.z(), t.y() * axis.y() + c, t.y() * axis.z() - s * axis.x(),
      t.z() * axis.x() - s * axis.y(), t.z() * axis.y() + s * axis.x(), t.z() * axis.z() + c;
  return R;
}

ArmPoses forward_kinematics(const ArmModel& arm, const Configuration& q) {
  SACCADE_EXPECTS(q.size() == arm.dof());
  ArmPoses poses;
  poses.T_world_link[0] = arm.T_world_base();
  for (int i = 0; i < arm.dof(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    poses.T_world_link[k + 1] = link_pose(poses.T_world_link[k], arm.joint(i), q[i]);
  }
  poses.T_world_camera = poses.T_world_link[static_cast<std::size_t>(arm.dof())] * arm.T_link_camera();
  return poses;
}

Pose camera_pose(const ArmModel& arm, const Configuration& q) {
  SACCADE_EXPECTS(q.size() == arm.dof());
  Pose T_world_link = arm.T_world_base();
  for (int i = 0; i < arm.dof(); ++i) T_world_link = link_pose(T_world_link, arm.joint(i), q[i]);
  return T_world_link * arm.T_link_camera();
}

Jacobian camera_jacobian(const ArmModel& arm, const Configuration& q) {
  return camera_jacobian(arm, forward_kinematics(arm, q));
}

Jacobian camera_jacobian(const ArmModel& arm, const ArmPoses& poses) {
  Jacobian J{6, arm.dof()};
  const Eigen::Vector3d p_world = poses.T_world_camera.translation();
  for (int i = 0; i < arm.dof(); ++i) {
    // Neither a rotation about the axis nor a translation along it moves the axis, so the frame behind the joint serves
    // as well.
    const Pose& T_world_link = poses.T_world_link[static_cast<std::size_t>(i) + 1];
    const Eigen::Vector3d axis_world = T_world_link.linear() * arm.joint(i).axis_joint;
    if (arm.joint(i).kind == JointKind::prismatic) {
      J.col(i) << axis_world, Eigen::Vector3d::Zero();
    } else {
      J.col(i) << axis_world.cross(p_world - T_world_link.translation()), axis_world;
    }
  }
  return J;
}

Eigen::Matrix<double, 6, 1> twist_between(const Pose& T_world_a, const Pose& T_world_b) {
  const Eigen::AngleAxisd turn{Eigen::Matrix3d{T_world_b.linear() * T_world_a.linear().transpose()}};
  Eigen::Matrix<double, 6, 1> twist;
  twist << T_world_b.translation() - T_world_a.translation(), turn.angle() * turn.axis();
  return twist;
}

double reach_bound_m(const ArmModel& arm) {
  double reach_m = arm.T_link_camera().translation().norm();
  for (int i = 0; i < arm.dof(); ++i) {
    const ArmJoint& joint = arm.joint(i);
    if (i > 0) reach_m += joint.T_parent_joint.translation().norm();
    if (joint.kind == JointKind::prismatic)
      reach_m += std::max(std::fabs(joint.limits.lower), std::fabs(joint.limits.upper));
  }
  return reach_m;
}

}  // namespace saccade
