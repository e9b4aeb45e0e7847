// SPDX-License-Identifier: Apache-2.0
#pragma once
// NumericIk: inverse kinematics of any arm by iteration from many starts (Orocos KDL). refine: improves a solution to
// the last digits.

#include <memory>
#include <vector>

#include "saccade/arm/inverse_kinematics.hpp"

namespace saccade {

/// Levenberg–Marquardt (KDL's ChainIkSolverPos_LMA) from the reference, then from random configurations. Solutions
/// outside the limits are shifted by whole turns, otherwise clamped to the limits and iterated once more. A reachable
/// pose may remain unsolved; more restarts make that rarer. Starts depend on the seed alone, so a pose has one answer,
/// independent of earlier poses and of the thread.
class NumericIk {
 public:
  /// Answers invalid_argument for a bad configuration.
  [[nodiscard]] static Result<NumericIk> create(std::shared_ptr<const ArmModel> arm,
                                                const NumericIkConfig& config = {});

  /// Returns solutions within the limits, each within kIkTolerance of the pose; empty where none was found. Takes from
  /// 10 µs to milliseconds for a pose that cannot be reached. Safe for concurrent use: each call has its own solver.
  [[nodiscard]] std::vector<Configuration> solve(const Pose& T_world_camera, const Configuration& reference) const;

 private:
  NumericIk(std::shared_ptr<const ArmModel> arm, const NumericIkConfig& config)
      : arm_{std::move(arm)}, config_{config} {}
  std::shared_ptr<const ArmModel> arm_;
  NumericIkConfig config_;
};

/// Refines a nearby solution by Newton's method, damped where the arm is singular. Tells whether q then meets the pose
/// within kIkTolerance; limits are ignored. At most ten iterations.
[[nodiscard]] bool refine(const ArmModel& arm, const Pose& T_world_camera, Configuration& q);

}  // namespace saccade
