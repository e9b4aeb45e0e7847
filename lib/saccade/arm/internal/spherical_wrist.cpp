// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/spherical_wrist.hpp"

#include <algorithm>
#include <string>

#include "saccade/arm/kinematics.hpp"

namespace saccade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSlack{1e-12};  // relative distance beyond the reach that counts as rounding

}  // namespace

/// State after q1.
struct SphericalWrist::Shoulder {
  double q1;
  Vector2d wrist;           ///< wrist's centre from axis 2, turned back about axis 1, in the plane across axis 2
  Eigen::Matrix3d R_1_tip;  ///< remaining rotation from q = 0
};

Result<SphericalWrist> SphericalWrist::find(const ArmModel& arm) {
  const ArmPoses zero = forward_kinematics(arm, Configuration::Zero(arm.dof()));
  SACCADE_TRY(const JointAxes axes, JointAxes::of(arm, zero));
  SphericalWrist ik;
  ik.axes_ = axes;
  const auto& a = axes.axis;
  const auto& p = axes.point;
  if (axes.are_parallel(3, 4) || axes.are_parallel(4, 5))
    return no_closed_form(arm, "neighbouring axes of its wrist are parallel");
  const ClosestPoint wrist = closest_point_of(p[3], a[3], p[4], a[4]);
  const double off_wrist_m = std::max(wrist.distance_m, distance_to_line(wrist.p, p[5], a[5]));
  if (off_wrist_m > JointAxes::kTolerance) return no_closed_form(arm, "the last three axes do not meet in a point");
  const double off_parallel = axes.off_parallel(1, 2);
  if (off_parallel > JointAxes::kTolerance) return no_closed_form(arm, "axes 2 and 3 are not parallel");
  if (axes.are_parallel(0, 1)) return no_closed_form(arm, "axes 1 and 2 are parallel");
  ik.exact_ = off_wrist_m < JointAxes::kExact && off_parallel < JointAxes::kExact;

  ik.p_camera_wrist_ = zero.T_world_camera.inverse() * wrist.p;
  ik.R_camera_world_ = zero.T_world_camera.linear().transpose();
  ik.wrist_along_a2_ = a[1].dot(wrist.p - p[0]);
  ik.u_ = a[1].unitOrthogonal();
  ik.v_ = a[1].cross(ik.u_);
  const auto in_plane = [&ik](const Vector3d& d) { return Vector2d{ik.u_.dot(d), ik.v_.dot(d)}; };
  const Vector2d upper = in_plane(p[2] - p[1]);
  const Vector2d fore = in_plane(wrist.p - p[2]);
  if (std::min(upper.norm(), fore.norm()) < JointAxes::kOblique)
    return no_closed_form(arm, "its upper arm or its forearm has no length");
  ik.links_ = TwoLinks{upper, fore};
  ik.sign3_ = axes.sign(1, 2);
  ik.wrist_ = ThreeTurns{axes, 3};
  return ik;
}

ClosedFormSolutions SphericalWrist::solve(const Pose& T_world_camera, const Configuration& reference) const {
  SACCADE_EXPECTS(reference.size() == 6);
  ClosedFormSolutions found;
  // a₂ · e^(−ξ₁q₁) r = wrist_along_a2: A cos q₁ + B sin q₁ = C.
  const auto& a = axes_.axis;
  const Vector3d r = T_world_camera * p_camera_wrist_ - axes_.point[0];
  const double along = a[0].dot(r);
  const double a12 = a[0].dot(a[1]);
  const AnglePair shoulders = angles_with(a[1].dot(r) - a12 * along, a[0].dot(a[1].cross(r)),
                                          wrist_along_a2_ - a12 * along, kSlack * links_.reach_m());
  const Eigen::Matrix3d R = T_world_camera.linear() * R_camera_world_;
  const auto with = [&](double q1) {
    if (!axes_.allow(0, q1)) return;
    const Vector3d wrist = axes_.point[0] + turned(a[0], -q1, r) - axes_.point[1];
    solve_elbow({q1, {u_.dot(wrist), v_.dot(wrist)}, rotation_about(a[0], -q1) * R}, reference, found);
  };
  if (shoulders.is_free) with(reference[0]);
  for (std::size_t i = 0; i < shoulders.count; ++i) with(shoulders.rad[i]);
  return found;
}

void SphericalWrist::solve_elbow(const Shoulder& shoulder, const Configuration& reference,
                                 ClosedFormSolutions& found) const {
  const TwoLinks::Solutions elbows = links_.reach(shoulder.wrist, reference[1]);
  for (std::size_t i = 0; i < elbows.count; ++i) {
    const double q2 = elbows.angles[i].first;
    const double q3 = sign3_ * elbows.angles[i].second;
    if (axes_.allow(2, q3) && axes_.allow(1, q2)) solve_wrist(shoulder, q2, q3, reference, found);
  }
}

void SphericalWrist::solve_wrist(const Shoulder& shoulder, double q2, double q3, const Configuration& reference,
                                 ClosedFormSolutions& found) const {
  const ThreeTurns::Solutions turns =
      wrist_.solve(rotation_about(axes_.axis[1], -(q2 + sign3_ * q3)) * shoulder.R_1_tip, reference[3]);
  for (std::size_t i = 0; i < turns.count; ++i) found.q[found.count++] << shoulder.q1, q2, q3, turns.q[i];
}

}  // namespace saccade
