// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/spherical_shoulder.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "saccade/arm/kinematics.hpp"

namespace saccade {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSwivelRounding{1e-12};  // distance beyond the range of swivels that counts as rounding

}  // namespace

/// State after q4.
struct SphericalShoulder::Elbow {
  double q4;
  Matrix3d R4;
  Matrix3d R;        ///< rotation of all six joints
  Matrix3d of_pose;  ///< x axis from S to W, as in the pose
  Matrix3d of_arm;   ///< x axis from S to W, as set by q4 alone
};

Result<SphericalShoulder> SphericalShoulder::find(const ArmModel& arm) {
  const ArmPoses zero = forward_kinematics(arm, Configuration::Zero(arm.dof()));
  SACCADE_TRY(const JointAxes axes, JointAxes::of(arm, zero));
  const auto& a = axes.axis;
  const auto& p = axes.point;
  if (axes.are_parallel(0, 1) || axes.are_parallel(1, 2))
    return no_closed_form(arm, "neighbouring axes of its shoulder are parallel");
  if (axes.are_parallel(4, 5)) return no_closed_form(arm, "axes 5 and 6 are parallel");
  const ClosestPoint S = closest_point_of(p[0], a[0], p[1], a[1]);
  const ClosestPoint W = closest_point_of(p[4], a[4], p[5], a[5]);
  const double off_shoulder_m = std::max(S.distance_m, distance_to_line(S.p, p[2], a[2]));
  if (off_shoulder_m > JointAxes::kTolerance) return no_closed_form(arm, "the first three axes do not meet in a point");
  if (W.distance_m > JointAxes::kTolerance) return no_closed_form(arm, "axes 5 and 6 do not meet");
  SphericalShoulder ik;
  ik.axes_ = axes;
  ik.exact_ = std::max(off_shoulder_m, W.distance_m) < JointAxes::kExact;
  ik.p_camera_W_ = zero.T_world_camera.inverse(Eigen::Isometry) * W.p;
  ik.R_camera_world_ = zero.T_world_camera.linear().transpose();
  ik.elbow_ = ElbowTriangle{S.p, W.p, a[0], p[3], a[3]};
  if (ik.elbow_.shortest_m() < JointAxes::kOblique)
    return no_closed_form(arm, "its upper arm or its forearm has no length");
  ik.cos_56_ = a[4].dot(a[5]);
  ik.across6_ = a[5].unitOrthogonal();
  ik.shoulder_ = ThreeTurns{axes, 0};
  return ik;
}

ClosedFormSolutions SphericalShoulder::solve(const Pose& T_world_camera, const Configuration& reference) const {
  SACCADE_EXPECTS(reference.size() == 6);
  ClosedFormSolutions found;
  const Vector3d S_W = T_world_camera * p_camera_W_ - elbow_.S();
  const AnglePair elbows = elbow_.elbows(S_W);
  if (elbows.count == 0) return found;
  Elbow elbow;
  elbow.R = T_world_camera.linear() * R_camera_world_;
  elbow.of_pose = elbow_.frame_of_pose(S_W);
  for (std::size_t i = 0; i < elbows.count; ++i) {
    elbow.q4 = elbows.rad[i];
    if (!axes_.allow(3, elbow.q4)) continue;
    elbow.R4 = rotation_about(axes_.axis[3], elbow.q4);
    elbow.of_arm = elbow_.frame_of_arm(elbow.R4);
    solve_swivel(elbow, reference, found);
  }
  return found;
}

void SphericalShoulder::solve_swivel(const Elbow& elbow, const Configuration& reference,
                                     ClosedFormSolutions& found) const {
  const Vector3d forearm = elbow.of_arm.transpose() * (elbow.R4 * axes_.axis[4]);
  const Vector3d hand = elbow.of_pose.transpose() * (elbow.R * axes_.axis[5]);
  const AnglePair swivels =
      angles_with(hand.y() * forearm.y() + hand.z() * forearm.z(), hand.z() * forearm.y() - hand.y() * forearm.z(),
                  cos_56_ - hand.x() * forearm.x(), kSwivelRounding);
  if (swivels.is_free) solve_rest(elbow, swivel_near(axes_, reference, elbow.of_pose, elbow.of_arm), reference, found);
  for (std::size_t i = 0; i < swivels.count; ++i) solve_rest(elbow, swivels.rad[i], reference, found);
}

void SphericalShoulder::solve_rest(const Elbow& elbow, double swivel, const Configuration& reference,
                                   ClosedFormSolutions& found) const {
  const Matrix3d R123 = elbow.of_pose * turn_about_x(swivel) * elbow.of_arm.transpose();
  const Matrix3d R56 = (R123 * elbow.R4).transpose() * elbow.R;
  const double q5 = angle_about(axes_.axis[4], axes_.axis[5], R56 * axes_.axis[5]);
  if (!axes_.allow(4, q5)) return;
  const double q6 = angle_about(axes_.axis[5], across6_, turned(axes_.axis[4], -q5, R56 * across6_));
  if (!axes_.allow(5, q6)) return;
  const ThreeTurns::Solutions turns = shoulder_.solve(R123, reference[0]);
  for (std::size_t i = 0; i < turns.count; ++i) found.q[found.count++] << turns.q[i], elbow.q4, q5, q6;
}

}  // namespace saccade
