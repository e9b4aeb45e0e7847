// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/joint_axes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "saccade/arm/internal/joint_turns.hpp"

namespace saccade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kFallTogether{1e-10};  // shorter vectors and smaller angles define no direction
constexpr double kBeyondReach{1e-12};   // relative distance beyond the reach that counts as rounding

double square_of(double x) { return x * x; }

}  // namespace

Result<JointAxes> JointAxes::of(const ArmModel& arm, const ArmPoses& zero, int joints) {
  SACCADE_EXPECTS(joints == 6 || joints == 7);
  if (arm.dof() != joints) {
    return no_closed_form(arm,
                          "it has " + std::to_string(arm.dof()) + " joints, not " + (joints == 6 ? "six" : "seven"));
  }
  JointAxes axes;
  for (int i = 0; i < arm.dof(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const ArmJoint& joint = arm.joint(i);
    if (joint.kind == JointKind::prismatic) return no_closed_form(arm, "joint " + joint.name + " is prismatic");
    axes.axis[k] = zero.T_world_link[k + 1].linear() * joint.axis_joint;
    axes.point[k] = zero.T_world_link[k + 1].translation();
    axes.lower[k] = joint.limits.lower;
    axes.upper[k] = joint.limits.upper;
  }
  return axes;
}

bool JointAxes::allow(std::size_t joint, double angle_rad) const {
  return has_turn_within(angle_rad, lower[joint], upper[joint]);
}

Error no_closed_form(const ArmModel& arm, const std::string& why) {
  return {Errc::unsupported, "no closed form: " + why, "arm " + arm.name()};
}

double wrapped(double angle_rad) { return std::remainder(angle_rad, 2.0 * pi); }

double angle_between(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

double angle_about(const Vector3d& axis, const Vector3d& a, const Vector3d& b) {
  return std::atan2(axis.dot(a.cross(b)), a.dot(b) - axis.dot(a) * axis.dot(b));
}

Vector3d turned(const Vector3d& axis, double angle_rad, const Vector3d& r) {
  const double s = std::sin(angle_rad);
  const double c = std::cos(angle_rad);
  return c * r + s * axis.cross(r) + (1.0 - c) * axis.dot(r) * axis;
}

double distance_to_line(const Vector3d& p, const Vector3d& q, const Vector3d& axis) { return axis.cross(p - q).norm(); }

ClosestPoint closest_point_of(const Vector3d& p, const Vector3d& a, const Vector3d& q, const Vector3d& b) {
  const double ab = a.dot(b);
  const Vector3d d = q - p;
  const double sin2 = 1.0 - ab * ab;
  const double s = (d.dot(a) - ab * d.dot(b)) / sin2;
  const double t = (ab * d.dot(a) - d.dot(b)) / sin2;
  const Vector3d on_a = p + s * a;
  const Vector3d on_b = q + t * b;
  return {0.5 * (on_a + on_b), (on_a - on_b).norm()};
}

AnglePair angles_with(double A, double B, double C, double slack) {
  AnglePair found;
  const double h = std::hypot(A, B);
  if (!(std::fabs(C) <= h + slack)) return found;
  if (h < kFallTogether) {
    found.is_free = true;
    return found;
  }
  const double middle = std::atan2(B, A);
  const double half = std::atan2(std::sqrt(std::max(0.0, (h - C) * (h + C))), C);
  found.rad[found.count++] = wrapped(middle + half);
  if (half > kFallTogether && half < pi - kFallTogether) found.rad[found.count++] = wrapped(middle - half);
  return found;
}

AnglePair angles_across(double alpha_rad, double beta_rad, double theta_rad) {
  AnglePair found;
  const double open =
      std::sin(0.5 * (theta_rad + alpha_rad - beta_rad)) * std::sin(0.5 * (theta_rad - alpha_rad + beta_rad));
  const double shut =
      std::sin(0.5 * (alpha_rad + beta_rad - theta_rad)) * std::sin(0.5 * (alpha_rad + beta_rad + theta_rad));
  if (!(open >= -kBeyondReach && shut >= -kBeyondReach)) return found;
  const double half = 2.0 * std::atan2(std::sqrt(std::max(0.0, open)), std::sqrt(std::max(0.0, shut)));
  found.rad[found.count++] = half;
  if (half > kFallTogether && half < pi - kFallTogether) found.rad[found.count++] = -half;
  return found;
}

std::vector<double> spread_over(double lower, double upper, int count) {
  constexpr double kGoldenRatio{0.61803398874989485};  // the fractional parts of its multiples are well spread
  std::vector<std::pair<double, double>> keyed;
  for (int i = 0; i < count; ++i) {
    const double multiple = kGoldenRatio * (i + 1);
    keyed.emplace_back(multiple - std::floor(multiple), lower + (upper - lower) * (i + 0.5) / count);
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<double> values;
  for (const auto& [key, value] : keyed) values.push_back(value);
  return values;
}

TwoLinks::TwoLinks(const Vector2d& upper, const Vector2d& fore)
    : upper_{upper},
      fore_{fore},
      upper_m_{upper.norm()},
      fore_m_{fore.norm()},
      zero_{std::atan2(fore.y(), fore.x()) - std::atan2(upper.y(), upper.x())} {}

TwoLinks::Solutions TwoLinks::reach(const Vector2d& point, double first_if_free) const {
  // |point|² = upper² + fore² + 2 upper fore cos γ, γ: the angle from the first link to the second.
  Solutions found;
  const double distance2 = point.squaredNorm();
  const double longest2 = square_of(upper_m_ + fore_m_);
  const double folded = longest2 - distance2;                          // 4 upper fore sin²(γ/2)
  const double stretched = distance2 - square_of(upper_m_ - fore_m_);  // 4 upper fore cos²(γ/2)
  if (!(folded >= -kBeyondReach * longest2 && stretched >= -kBeyondReach * longest2)) return found;
  const double gamma = 2.0 * std::atan2(std::sqrt(std::max(0.0, folded)), std::sqrt(std::max(0.0, stretched)));
  const bool twice = gamma > kFallTogether && gamma < pi - kFallTogether;
  const bool first_is_free = distance2 < square_of(kFallTogether);
  found.count = twice ? 2 : 1;
  for (std::size_t i = 0; i < found.count; ++i) {
    Angles& angles = found.angles[i];
    angles.second = wrapped((i == 0 ? gamma : -gamma) - zero_);
    const Vector2d end = upper_ + Eigen::Rotation2Dd{angles.second} * fore_;
    angles.first =
        first_is_free ? first_if_free : wrapped(std::atan2(point.y(), point.x()) - std::atan2(end.y(), end.x()));
  }
  return found;
}

}  // namespace saccade
