// SPDX-License-Identifier: Apache-2.0
#pragma once
// JointController: moves the joints of an arm along timed positions. SimulatedJoints does so exactly and instantly.

#include <functional>
#include <optional>

#include "saccade/core/result.hpp"
#include "saccade/robot/trajectory.hpp"

namespace saccade {

/// Joint positions during a motion.
struct JointSample {
  double t_s{0.0};  ///< since the motion began
  Configuration q;
  std::optional<double> time_s{};  ///< on the joints' clock, where they have one
};
using JointObserver = std::function<Advance(const JointSample& sample)>;

/// End of a motion of joints.
struct JointArrival {
  Configuration q;      ///< final positions
  bool stopped{false};  ///< early, because the observer or the caller asked for it
};

/// Controller of an arm's joints. One caller at a time.
class JointController {
 public:
  virtual ~JointController() = default;
  /// Returns the current joint positions.
  [[nodiscard]] virtual Result<Configuration> position() = 0;
  /// Follows a trajectory that begins at the current positions. Calls `observer` at samples during the motion; it may
  /// stop the motion.
  /// @return the final joint positions. After an Error these are unknown.
  [[nodiscard]] virtual Result<JointArrival> execute(const Trajectory& trajectory,
                                                     const JointObserver& observer = {}) = 0;
};

/// Simulated joints that jump to the end of a trajectory, or to the sample at which it was stopped. Samples lie every
/// kSample_s of the trajectory's time, and at its end.
class SimulatedJoints final : public JointController {
 public:
  static constexpr double kSample_s{0.02};
  explicit SimulatedJoints(Configuration q) : q_{std::move(q)} {}
  [[nodiscard]] Result<Configuration> position() override { return q_; }
  [[nodiscard]] Result<JointArrival> execute(const Trajectory& trajectory, const JointObserver& observer = {}) override;

 private:
  Configuration q_;
};

}  // namespace saccade
