// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/three_turns.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "saccade/arm/internal/joint_turns.hpp"

namespace saccade {
namespace {

constexpr double kInLine{1e-10};  // axes with a smaller angle are collinear

}  // namespace

ThreeTurns::ThreeTurns(const JointAxes& axes, std::size_t first)
    : alpha_{angle_between(axes.axis[first], axes.axis[first + 1])},
      beta_{angle_between(axes.axis[first + 1], axes.axis[first + 2])},
      phi_{angle_about(axes.axis[first + 1], axes.axis[first + 2], axes.axis[first])},
      across_{axes.axis[first + 2].unitOrthogonal()} {
  for (std::size_t i = 0; i < 3; ++i) {
    axis_[i] = axes.axis[first + i];
    lower_[i] = axes.lower[first + i];
    upper_[i] = axes.upper[first + i];
  }
}

bool ThreeTurns::allow(std::size_t joint, double angle_rad) const {
  return has_turn_within(angle_rad, lower_[joint], upper_[joint]);
}

ThreeTurns::Solutions ThreeTurns::solve(const Eigen::Matrix3d& R, double first_if_free) const {
  Solutions found;
  const Eigen::Vector3d u = R * axis_[2];
  const double theta = angle_between(axis_[0], u);
  const bool in_line = theta < kInLine || theta > std::numbers::pi - kInLine;
  const AnglePair bends = angles_across(alpha_, beta_, theta);
  for (std::size_t i = 0; i < bends.count; ++i) {
    Eigen::Vector3d q{0.0, wrapped(phi_ + bends.rad[i]), 0.0};
    if (!allow(1, q[1])) continue;
    q[0] = in_line ? first_if_free : angle_about(axis_[0], turned(axis_[1], q[1], axis_[2]), u);
    if (!allow(0, q[0])) continue;
    q[2] = angle_about(axis_[2], across_, turned(axis_[1], -q[1], turned(axis_[0], -q[0], R * across_)));
    if (in_line) give_way(theta < 1.0 ? 1.0 : -1.0, q);
    if (allow(0, q[0]) && allow(2, q[2])) found.q[found.count++] = q;
  }
  return found;
}

/// Shifts the angles where only the first + sign · the third counts: where the third exceeds its limits, the first
/// takes the rest.
void ThreeTurns::give_way(double sign, Eigen::Vector3d& q) const {
  if (allow(2, q[2])) return;
  const double to_lower = wrapped(lower_[2] - q[2]);
  const double to_upper = wrapped(upper_[2] - q[2]);
  const bool lower_first = std::fabs(to_lower) <= std::fabs(to_upper);
  for (const double change : {lower_first ? to_lower : to_upper, lower_first ? to_upper : to_lower}) {
    if (!allow(0, q[0] - sign * change)) continue;
    q[0] -= sign * change;
    q[2] += change;
    return;
  }
}

}  // namespace saccade
