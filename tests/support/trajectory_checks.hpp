// SPDX-License-Identifier: Apache-2.0
#pragma once
// Checks of trajectories, piece by piece and sample by sample.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "saccade/robot/trajectory.hpp"

namespace saccade::test {

constexpr double kMet{1e-9};  ///< configurations, speeds and limits are met to this

/// Distance of q from the straight line between two configurations.
inline double distance_from_line(const Configuration& q, const Configuration& a, const Configuration& b) {
  const Configuration step = b - a;
  const double squared = step.squaredNorm();
  const double share = squared > 0.0 ? std::clamp((q - a).dot(step) / squared, 0.0, 1.0) : 0.0;
  return (q - a - share * step).norm();
}

/// Index of the line of the path that q is nearest to, and how near.
struct OnPath {
  std::size_t line{0};
  double away{std::numeric_limits<double>::infinity()};
};
inline OnPath on_path(const Configuration& q, const JointPath& path) {
  OnPath nearest;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const double away = distance_from_line(q, path[i], path[i + 1]);
    if (away < nearest.away) nearest = {i, away};
  }
  return nearest;
}

/// Continuous in position and speed, at rest at both ends of the path, never beyond speed or acceleration: on a piece
/// of constant acceleration each joint is fastest at one of its ends.
inline void expect_sound(const ArmModel& arm, const JointPath& path, const Trajectory& trajectory) {
  ASSERT_FALSE(trajectory.empty());
  const auto& pieces = trajectory.pieces();
  ASSERT_LT((pieces.front().q - path.front()).lpNorm<Eigen::Infinity>(), kMet);
  ASSERT_LT((trajectory.end() - path.back()).lpNorm<Eigen::Infinity>(), kMet);
  ASSERT_LT(pieces.front().speed.lpNorm<Eigen::Infinity>(), kMet);
  Configuration q = pieces.front().q;
  Configuration speed = pieces.front().speed;
  double sum_s = 0.0;
  for (const Trajectory::Piece& piece : pieces) {
    ASSERT_GE(piece.duration_s, 0.0);
    ASSERT_TRUE(std::isfinite(piece.duration_s));
    ASSERT_TRUE(piece.q.allFinite() && piece.speed.allFinite() && piece.acceleration.allFinite());
    ASSERT_LT((piece.q - q).lpNorm<Eigen::Infinity>(), kMet) << "a jump at " << sum_s << " s";
    ASSERT_LT((piece.speed - speed).lpNorm<Eigen::Infinity>(), kMet) << "a jerk at " << sum_s << " s";
    q = piece.q + piece.duration_s * piece.speed + 0.5 * piece.duration_s * piece.duration_s * piece.acceleration;
    speed = piece.speed + piece.duration_s * piece.acceleration;
    for (int i = 0; i < arm.dof(); ++i) {
      const JointLimits& limits = arm.joint(i).limits;
      ASSERT_LE(std::fabs(piece.speed[i]), limits.speed * (1.0 + kMet)) << "joint " << i << " at " << sum_s << " s";
      ASSERT_LE(std::fabs(speed[i]), limits.speed * (1.0 + kMet)) << "joint " << i << " at " << sum_s << " s";
      ASSERT_LE(std::fabs(piece.acceleration[i]), limits.acceleration * (1.0 + kMet))
          << "joint " << i << " at " << sum_s << " s";
    }
    sum_s += piece.duration_s;
  }
  ASSERT_LT(speed.lpNorm<Eigen::Infinity>(), kMet);
  ASSERT_NEAR(sum_s, trajectory.duration_s(), kMet);
}

}  // namespace saccade::test
