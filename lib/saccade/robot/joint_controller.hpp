// SPDX-License-Identifier: Apache-2.0
#pragma once
// JointController: moves the joints of an arm along timed positions; SimulatedJoints does so exactly, in no time.

#include <functional>
#include <optional>

#include "saccade/core/result.hpp"
#include "saccade/robot/trajectory.hpp"

namespace saccade {

/// Joint positions on the way.
struct JointSample {
  double t_s{0.0};  ///< since the motion began
  Configuration q;
  std::optional<double> time_s{};  ///< on the clock of the joints, where they have one
};
using JointObserver = std::function<Advance(const JointSample& sample)>;

/// The end of a motion of joints.
struct JointArrival {
  Configuration q;      ///< as they stand
  bool stopped{false};  ///< on the way, because the observer said so or the caller cancelled
};

/// One caller at a time.
class JointController {
 public:
  virtual ~JointController() = default;
  /// @return the joints as they stand.
  [[nodiscard]] virtual Result<Configuration> position() = 0;
  /// Follows a trajectory that begins where the joints stand; `observer` is called at samples on the way, and may stop
  /// the motion.
  /// @return the joints as they stand at the end. An Error means that this is not known.
  [[nodiscard]] virtual Result<JointArrival> execute(const Trajectory& trajectory,
                                                     const JointObserver& observer = {}) = 0;
};

/// Stands at the end of the last trajectory at once, or at the sample at which it was stopped. Samples every kSample_s
/// of the trajectory's time, and at its end.
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
