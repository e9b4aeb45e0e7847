// SPDX-License-Identifier: Apache-2.0
#pragma once
// NumericIk: inverse kinematics of any arm by iteration from many starts (Orocos KDL); refine: the last digits.

#include <memory>
#include <vector>

#include "saccade/arm/inverse_kinematics.hpp"

namespace saccade {

/// Levenberg–Marquardt (KDL's ChainIkSolverPos_LMA) from the reference, then from random configurations; what it finds
/// outside the limits is turned by whole turns, else put on them and iterated once more.
/// A pose may go unsolved though it can be reached: more restarts make that rarer. Starts depend on the seed alone, so
/// every pose has the same answer whatever is asked before it and on whatever thread.
class NumericIk {
 public:
  /// invalid_argument for a bad configuration.
  [[nodiscard]] static Result<NumericIk> create(std::shared_ptr<const ArmModel> arm,
                                                const NumericIkConfig& config = {});

  /// Within the limits, each within kIkTolerance of the pose; none where none was found. From 10 µs to milliseconds for
  /// a pose that cannot be reached. Safe for concurrent use: each call has a solver of its own.
  [[nodiscard]] std::vector<Configuration> solve(const Pose& T_world_camera, const Configuration& reference) const;

 private:
  NumericIk(std::shared_ptr<const ArmModel> arm, const NumericIkConfig& config)
      : arm_{std::move(arm)}, config_{config} {}
  std::shared_ptr<const ArmModel> arm_;
  NumericIkConfig config_;
};

/// Newton's method from a near solution, damped where the arm is singular. Whether q then meets the pose within
/// kIkTolerance; limits are not looked at. Ten iterations at most.
[[nodiscard]] bool refine(const ArmModel& arm, const Pose& T_world_camera, Configuration& q);

}  // namespace saccade
