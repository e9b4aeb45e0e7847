// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/swivel_elbow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "saccade/arm/kinematics.hpp"

namespace saccade {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSameSwivel_rad{1e-6};  // samples this near to the reference's swivel are skipped

}  // namespace

Result<SwivelElbow> SwivelElbow::find(const ArmModel& arm, int samples) {
  SACCADE_EXPECTS(samples >= 1);
  const ArmPoses zero = forward_kinematics(arm, Configuration::Zero(arm.dof()));
  SACCADE_TRY(const JointAxes axes, JointAxes::of(arm, zero, 7));
  const auto& a = axes.axis;
  const auto& p = axes.point;
  if (axes.are_parallel(0, 1) || axes.are_parallel(1, 2) || axes.are_parallel(4, 5) || axes.are_parallel(5, 6))
    return no_closed_form(arm, "neighbouring axes of its shoulder or of its wrist are parallel");
  const ClosestPoint S = closest_point_of(p[0], a[0], p[1], a[1]);
  const ClosestPoint W = closest_point_of(p[4], a[4], p[5], a[5]);
  const double off_m =
      std::max({S.distance_m, distance_to_line(S.p, p[2], a[2]), W.distance_m, distance_to_line(W.p, p[6], a[6])});
  if (off_m > JointAxes::kTolerance)
    return no_closed_form(arm, "its first three axes, or its last three, do not meet in a point");
  SwivelElbow ik;
  ik.axes_ = axes;
  ik.exact_ = off_m < JointAxes::kExact;
  ik.elbow_ = ElbowTriangle{S.p, W.p, a[0], p[3], a[3]};
  if (ik.elbow_.shortest_m() < JointAxes::kOblique)
    return no_closed_form(arm, "its upper arm or its forearm has no length");
  ik.p_camera_W_ = zero.T_world_camera.inverse(Eigen::Isometry) * W.p;
  ik.R_camera_world_ = zero.T_world_camera.linear().transpose();
  ik.shoulder_ = ThreeTurns{axes, 0};
  ik.wrist_ = ThreeTurns{axes, 4};
  for (const double swivel : spread_over(-std::numbers::pi, std::numbers::pi, samples))
    ik.samples_.push_back({swivel, turn_about_x(swivel)});
  return ik;
}

SevenSolutions SwivelElbow::solve(const Pose& T_world_camera, const Configuration& reference, std::size_t round) const {
  SACCADE_EXPECTS(reference.size() == 7 && round < rounds());
  SevenSolutions found;
  const Vector3d S_W = T_world_camera * p_camera_W_ - elbow_.S();
  const AnglePair elbows = elbow_.elbows(S_W);
  if (elbows.count == 0) return found;
  const Matrix3d R = T_world_camera.linear() * R_camera_world_;
  const Matrix3d of_pose = elbow_.frame_of_pose(S_W);
  for (std::size_t i = 0; i < elbows.count; ++i) {
    const double q4 = elbows.rad[i];
    if (!axes_.allow(3, q4)) continue;
    const Matrix3d R4 = rotation_about(axes_.axis[3], q4);
    const Matrix3d of_arm = elbow_.frame_of_arm(R4);
    const double own = swivel_near(axes_, reference, of_pose, of_arm);
    if (round > 0 && std::fabs(wrapped(samples_[round - 1].swivel_rad - own)) < kSameSwivel_rad) continue;
    const Matrix3d swivel = round == 0 ? turn_about_x(own) : samples_[round - 1].R;
    const Matrix3d R123 = of_pose * swivel * of_arm.transpose();
    const ThreeTurns::Solutions shoulders = shoulder_.solve(R123, reference[0]);
    if (shoulders.count == 0) continue;
    const ThreeTurns::Solutions wrists = wrist_.solve((R123 * R4).transpose() * R, reference[4]);
    for (std::size_t k = 0; k < shoulders.count; ++k) {
      for (std::size_t m = 0; m < wrists.count; ++m) found.q[found.count++] << shoulders.q[k], q4, wrists.q[m];
    }
  }
  return found;
}

}  // namespace saccade
