// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/parallel_axes.hpp"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNoDirection{1e-10};  // shorter vectors define no direction
constexpr double kRounding{1e-12};     // relative distance beyond the reach that counts as rounding

}  // namespace

/// State after q1.
struct ParallelAxes::Shoulder {
  double q1;
  Pose T_rest;  ///< e₂ e₃ e₄ e₅ e₆
};

Result<ParallelAxes> ParallelAxes::find(const ArmModel& arm) {
  const ArmPoses zero = forward_kinematics(arm, Configuration::Zero(arm.dof()));
  SACCADE_TRY(const JointAxes axes, JointAxes::of(arm, zero));
  const auto& a = axes.axis;
  const auto& p = axes.point;
  const double off_parallel = std::max(axes.off_parallel(1, 2), axes.off_parallel(1, 3));
  if (off_parallel > JointAxes::kTolerance) return no_closed_form(arm, "axes 2, 3 and 4 are not parallel");
  if (axes.are_parallel(0, 1)) return no_closed_form(arm, "axes 1 and 2 are parallel");
  if (axes.are_parallel(3, 4) || axes.are_parallel(4, 5))
    return no_closed_form(arm, "neighbouring axes of its wrist are parallel");
  const ClosestPoint wrist = closest_point_of(p[4], a[4], p[5], a[5]);
  if (wrist.distance_m > JointAxes::kTolerance) return no_closed_form(arm, "axes 5 and 6 do not meet");
  ParallelAxes ik;
  ik.axes_ = axes;
  ik.exact_ = wrist.distance_m < JointAxes::kExact && off_parallel < JointAxes::kExact;
  ik.T_camera_world_ = zero.T_world_camera.inverse(Eigen::Isometry);
  ik.P_ = wrist.p;
  ik.u_ = a[1].unitOrthogonal();
  ik.v_ = a[1].cross(ik.u_);
  const auto in_plane = [&ik](const Vector3d& d) { return Vector2d{ik.u_.dot(d), ik.v_.dot(d)}; };
  const Vector2d upper = in_plane(p[2] - p[1]);
  const Vector2d fore = in_plane(p[3] - p[2]);
  if (std::min(upper.norm(), fore.norm()) < JointAxes::kOblique)
    return no_closed_form(arm, "its upper arm or its forearm has no length");
  ik.links_ = TwoLinks{upper, fore};
  ik.sign3_ = axes.sign(1, 2);
  ik.sign4_ = axes.sign(1, 3);
  ik.alpha_ = angle_between(a[1], a[4]);
  ik.beta_ = angle_between(a[4], a[5]);
  ik.phi5_ = angle_about(a[4], a[5], a[1]);
  return ik;
}

ClosedFormSolutions ParallelAxes::solve(const Pose& T_world_camera, const Configuration& reference) const {
  SACCADE_EXPECTS(reference.size() == 6);
  ClosedFormSolutions found;
  // a₂ · e₁⁻¹ r = a₂ · (P − p₁), where r leads from axis 1 to G P: A cos q₁ + B sin q₁ = C.
  const auto& a = axes_.axis;
  const Vector3d& p1 = axes_.point[0];
  const Pose G = T_world_camera * T_camera_world_;
  const Vector3d r = G * P_ - p1;
  const double along = a[0].dot(r);
  const double a12 = a[0].dot(a[1]);
  const AnglePair shoulders = angles_with(a[1].dot(r) - a12 * along, a[0].dot(a[1].cross(r)),
                                          a[1].dot(P_ - p1) - a12 * along, kRounding * links_.reach_m());
  const auto with = [&](double q1) {
    if (!axes_.allow(0, q1)) return;
    Pose back = Pose::Identity();
    back.linear() = rotation_about(a[0], -q1);
    back.translation() = p1 - back.linear() * p1;
    solve_wrist({q1, back * G}, reference, found);
  };
  if (shoulders.is_free) with(reference[0]);
  for (std::size_t i = 0; i < shoulders.count; ++i) with(shoulders.rad[i]);
  return found;
}

void ParallelAxes::solve_wrist(const Shoulder& shoulder, const Configuration& reference,
                               ClosedFormSolutions& found) const {
  // The remaining rotation R takes a₆ to an angle from a₂ that joints 2 to 4 do not change.
  const auto& a = axes_.axis;
  const Eigen::Matrix3d R = shoulder.T_rest.linear();
  const AnglePair bends = angles_across(alpha_, beta_, angle_between(a[1], R * a[5]));
  const Vector3d before = R.transpose() * a[1];
  for (std::size_t i = 0; i < bends.count; ++i) {
    const double q5 = wrapped(phi5_ + bends.rad[i]);
    if (!axes_.allow(4, q5)) continue;
    const Vector3d after = turned(a[4], -q5, a[1]);
    // Components across axis 6, which keep their digits where they are short.
    const Vector3d from = a[5].cross(before);
    const Vector3d to = a[5].cross(after);
    const double q6 = to.norm() < kNoDirection ? reference[5] : angle_about(a[5], from, to);
    if (axes_.allow(5, q6)) solve_elbow(shoulder, q5, q6, reference, found);
  }
}

void ParallelAxes::solve_elbow(const Shoulder& shoulder, double q5, double q6, const Configuration& reference,
                               ClosedFormSolutions& found) const {
  // e₂ e₃ e₄ = e₁⁻¹ G e₆⁻¹ e₅⁻¹; joints 5 and 6 turn about P.
  const auto& a = axes_.axis;
  const Eigen::Matrix3d R = shoulder.T_rest.linear() * rotation_about(a[5], -q6) * rotation_about(a[4], -q5);
  const Vector3d axis4 = shoulder.T_rest * P_ + R * (axes_.point[3] - P_) - axes_.point[1];
  const double turn = std::atan2(v_.dot(R * u_), u_.dot(R * u_));
  const TwoLinks::Solutions elbows = links_.reach({u_.dot(axis4), v_.dot(axis4)}, reference[1]);
  for (std::size_t i = 0; i < elbows.count; ++i) {
    const TwoLinks::Angles& angles = elbows.angles[i];
    Eigen::Matrix<double, 6, 1> q;
    q << shoulder.q1, angles.first, sign3_ * angles.second, sign4_ * wrapped(turn - angles.first - angles.second), q5,
        q6;
    if (axes_.allow(1, q[1]) && axes_.allow(2, q[2]) && axes_.allow(3, q[3])) found.q[found.count++] = q;
  }
}

}  // namespace saccade
