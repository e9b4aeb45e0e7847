// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/spherical_wrist.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "saccade/arm/internal/joint_turns.hpp"
#include "saccade/arm/kinematics.hpp"

namespace saccade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kExact{1e-12};     ///< axes that meet or are parallel to the last digits
constexpr double kOblique{1e-3};    ///< axes that must not be parallel differ by more, rad
constexpr double kSingular{1e-10};  ///< below this length or angle a direction is none
constexpr double kSlack{1e-12};     ///< how far beyond the reach a pose may lie by rounding, relative

double square_of(double x) { return x * x; }

double wrapped(double angle_rad) { return std::remainder(angle_rad, 2.0 * pi); }

/// Angle between unit vectors, in [0, π].
double angle_between(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// Angle of the turn about a unit axis that takes a's part across it to b's.
double angle_about(const Vector3d& axis, const Vector3d& a, const Vector3d& b) {
  return std::atan2(axis.dot(a.cross(b)), a.dot(b) - axis.dot(a) * axis.dot(b));
}

/// r turned about a unit axis, without a matrix.
Vector3d turned(const Vector3d& axis, double angle_rad, const Vector3d& r) {
  const double s = std::sin(angle_rad);
  const double c = std::cos(angle_rad);
  return c * r + s * axis.cross(r) + (1.0 - c) * axis.dot(r) * axis;
}

Error misfit(const ArmModel& arm, const std::string& what) {
  return {Errc::unsupported, "no closed form: " + what, "arm " + arm.name()};
}

/// Point nearest to two lines (the middle of their shortest connection), and how far apart they are.
struct Meeting {
  Vector3d p;
  double distance_m;
};
Meeting meeting_of(const Vector3d& p, const Vector3d& a, const Vector3d& q, const Vector3d& b) {
  const double ab = a.dot(b);
  const Vector3d d = q - p;
  const double sin2 = 1.0 - ab * ab;
  const double s = (d.dot(a) - ab * d.dot(b)) / sin2;
  const double t = (ab * d.dot(a) - d.dot(b)) / sin2;
  const Vector3d on_a = p + s * a;
  const Vector3d on_b = q + t * b;
  return {0.5 * (on_a + on_b), (on_a - on_b).norm()};
}

double distance_to_line(const Vector3d& p, const Vector3d& q, const Vector3d& axis) { return axis.cross(p - q).norm(); }

}  // namespace

/// What q1 leaves to the others.
struct SphericalWrist::Shoulder {
  double q1;
  Vector2d wrist;           ///< its centre from axis 2, turned back about axis 1, in the plane across axis 2
  Eigen::Matrix3d R_1_tip;  ///< what is left of the turn away from q = 0
};

Result<SphericalWrist> SphericalWrist::find(const ArmModel& arm) {
  if (arm.dof() != 6) return misfit(arm, "it has " + std::to_string(arm.dof()) + " joints, not six");
  SphericalWrist ik;
  const ArmPoses zero = forward_kinematics(arm, Configuration::Zero(6));
  std::array<Vector3d, 6> p;
  for (int i = 0; i < 6; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (arm.joint(i).kind == JointKind::prismatic) return misfit(arm, "joint " + arm.joint(i).name + " is prismatic");
    ik.axis_[k] = zero.T_world_link[k + 1].linear() * arm.joint(i).axis_joint;
    p[k] = zero.T_world_link[k + 1].translation();
    ik.lower_[k] = arm.joint(i).limits.lower;
    ik.upper_limit_[k] = arm.joint(i).limits.upper;
  }
  const auto& a = ik.axis_;
  const auto parallel = [&a](std::size_t i, std::size_t k) { return a[i].cross(a[k]).norm() < kOblique; };
  if (parallel(3, 4) || parallel(4, 5)) return misfit(arm, "neighbouring axes of its wrist are parallel");
  const Meeting wrist = meeting_of(p[3], a[3], p[4], a[4]);
  const double off_wrist_m = std::max(wrist.distance_m, distance_to_line(wrist.p, p[5], a[5]));
  if (off_wrist_m > kTolerance) return misfit(arm, "the last three axes do not meet in a point");
  const double off_parallel = a[1].cross(a[2]).norm();
  if (off_parallel > kTolerance) return misfit(arm, "axes 2 and 3 are not parallel");
  if (parallel(0, 1)) return misfit(arm, "axes 1 and 2 are parallel");
  ik.exact_ = off_wrist_m < kExact && off_parallel < kExact;

  ik.p1_ = p[0];
  ik.p2_ = p[1];
  ik.p_camera_wrist_ = zero.T_world_camera.inverse() * wrist.p;
  ik.R_camera_world_ = zero.T_world_camera.linear().transpose();
  ik.wrist_along_a2_ = a[1].dot(wrist.p - p[0]);
  ik.u_ = a[1].unitOrthogonal();
  ik.v_ = a[1].cross(ik.u_);
  const auto in_plane = [&ik](const Vector3d& d) { return Vector2d{ik.u_.dot(d), ik.v_.dot(d)}; };
  ik.upper_ = in_plane(p[2] - p[1]);
  ik.fore_ = in_plane(wrist.p - p[2]);
  ik.upper_m_ = ik.upper_.norm();
  ik.fore_m_ = ik.fore_.norm();
  if (std::min(ik.upper_m_, ik.fore_m_) < kOblique) return misfit(arm, "its upper arm or its forearm has no length");
  ik.sign3_ = a[1].dot(a[2]) > 0.0 ? 1.0 : -1.0;
  ik.elbow_zero_ = std::atan2(ik.fore_.y(), ik.fore_.x()) - std::atan2(ik.upper_.y(), ik.upper_.x());
  ik.alpha_ = angle_between(a[3], a[4]);
  ik.beta_ = angle_between(a[4], a[5]);
  ik.phi5_ = angle_about(a[4], a[5], a[3]);
  ik.across6_ = a[5].unitOrthogonal();
  return ik;
}

bool SphericalWrist::allowed(int joint, double angle_rad) const {
  const auto k = static_cast<std::size_t>(joint);
  return has_turn_within(angle_rad, lower_[k], upper_limit_[k]);
}

WristSolutions SphericalWrist::solve(const Pose& T_world_camera, const Configuration& reference) const {
  SACCADE_EXPECTS(reference.size() == 6);
  WristSolutions found;
  // a₂ · e^(−ξ₁q₁) r = wrist_along_a2: A cos q₁ + B sin q₁ = C.
  const Vector3d r = T_world_camera * p_camera_wrist_ - p1_;
  const double along = axis_[0].dot(r);
  const double a12 = axis_[0].dot(axis_[1]);
  const double A = axis_[1].dot(r) - a12 * along;
  const double B = axis_[0].dot(axis_[1].cross(r));
  const double C = wrist_along_a2_ - a12 * along;
  const double h = std::hypot(A, B);
  if (std::fabs(C) > h + kSlack * (upper_m_ + fore_m_)) return found;
  const Eigen::Matrix3d R = T_world_camera.linear() * R_camera_world_;
  const auto with = [&](double q1) {
    if (!allowed(0, q1)) return;
    const Vector3d wrist = p1_ + turned(axis_[0], -q1, r) - p2_;
    solve_elbow({q1, {u_.dot(wrist), v_.dot(wrist)}, rotation_about(axis_[0], -q1) * R}, reference, found);
  };
  if (h < kSingular) {
    with(reference[0]);
    return found;
  }
  const double middle = std::atan2(B, A);
  const double half = std::atan2(std::sqrt(std::max(0.0, (h - C) * (h + C))), C);
  with(wrapped(middle + half));
  if (half > kSingular && half < pi - kSingular) with(wrapped(middle - half));
  return found;
}

void SphericalWrist::solve_elbow(const Shoulder& shoulder, const Configuration& reference,
                                 WristSolutions& found) const {
  // |wrist|² = upper² + fore² + 2 upper fore cos γ, γ: the angle from the upper arm to the forearm.
  const double distance2 = shoulder.wrist.squaredNorm();
  const double longest2 = square_of(upper_m_ + fore_m_);
  const double folded = longest2 - distance2;                          // 4 upper fore sin²(γ/2)
  const double stretched = distance2 - square_of(upper_m_ - fore_m_);  // 4 upper fore cos²(γ/2)
  if (folded < -kSlack * longest2 || stretched < -kSlack * longest2) return;
  const double gamma = 2.0 * std::atan2(std::sqrt(std::max(0.0, folded)), std::sqrt(std::max(0.0, stretched)));
  const bool twice = gamma > kSingular && gamma < pi - kSingular;
  const bool direction_is_free = distance2 < square_of(kSingular);
  const double direction = direction_is_free ? 0.0 : std::atan2(shoulder.wrist.y(), shoulder.wrist.x());
  for (const double bend : {gamma, -gamma}) {
    if (bend == -gamma && !twice) break;
    const double q3 = wrapped(sign3_ * (bend - elbow_zero_));
    if (!allowed(2, q3)) continue;
    const Vector2d arm = upper_ + Eigen::Rotation2Dd{sign3_ * q3} * fore_;
    const double q2 = direction_is_free ? reference[1] : wrapped(direction - std::atan2(arm.y(), arm.x()));
    if (allowed(1, q2)) solve_wrist(shoulder, q2, q3, reference, found);
  }
}

void SphericalWrist::solve_wrist(const Shoulder& shoulder, double q2, double q3, const Configuration& reference,
                                 WristSolutions& found) const {
  // R₄ R₅ R₆ = G. The angle θ between axis 4 and axis 6, which G leads to u, is a side of the spherical triangle of the
  // three axes, q₅ − φ the angle across it: sin²((q₅ − φ)/2) = sin((θ + α − β)/2) sin((θ − α + β)/2) / (sin α sin β).
  const Eigen::Matrix3d G = rotation_about(axis_[1], -(q2 + sign3_ * q3)) * shoulder.R_1_tip;
  const Vector3d u = G * axis_[5];
  const double theta = angle_between(axis_[3], u);
  const double open = std::sin(0.5 * (theta + alpha_ - beta_)) * std::sin(0.5 * (theta - alpha_ + beta_));
  const double shut = std::sin(0.5 * (alpha_ + beta_ - theta)) * std::sin(0.5 * (alpha_ + beta_ + theta));
  if (open < -kSlack || shut < -kSlack) return;
  const double half = 2.0 * std::atan2(std::sqrt(std::max(0.0, open)), std::sqrt(std::max(0.0, shut)));
  const bool twice = half > kSingular && half < pi - kSingular;
  for (const double bend : {half, -half}) {
    if (bend == -half && !twice) break;
    Eigen::Matrix<double, 6, 1> q;
    q << shoulder.q1, q2, q3, 0.0, wrapped(phi5_ + bend), 0.0;
    if (!allowed(4, q[4])) continue;
    const Vector3d before = turned(axis_[4], q[4], axis_[5]);
    const bool in_line = theta < kSingular || theta > pi - kSingular;
    q[3] = in_line ? reference[3] : angle_about(axis_[3], before, u);
    if (!allowed(3, q[3])) continue;
    const Vector3d across = turned(axis_[4], -q[4], turned(axis_[3], -q[3], G * across6_));
    q[5] = angle_about(axis_[5], across6_, across);
    if (in_line) give_way(theta < 1.0 ? 1.0 : -1.0, q);
    if (allowed(3, q[3]) && allowed(5, q[5])) found.q[found.count++] = q;
  }
}

/// With axes 4 and 6 in one line only q4 + sign · q6 counts: where q6 breaks its limits, q4 takes what is missing.
void SphericalWrist::give_way(double sign, Eigen::Matrix<double, 6, 1>& q) const {
  if (allowed(5, q[5])) return;
  const double to_lower = wrapped(lower_[5] - q[5]);
  const double to_upper = wrapped(upper_limit_[5] - q[5]);
  const bool lower_first = std::fabs(to_lower) <= std::fabs(to_upper);
  for (const double change : {lower_first ? to_lower : to_upper, lower_first ? to_upper : to_lower}) {
    if (!allowed(3, q[3] - sign * change)) continue;
    q[3] -= sign * change;
    q[5] += change;
    return;
  }
}

}  // namespace saccade
