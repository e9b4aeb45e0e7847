// SPDX-License-Identifier: Apache-2.0
#pragma once
// Trajectory: a path of an arm with its times, within the limits of speed and acceleration.

#include <functional>
#include <vector>

#include "saccade/robot/arm_model.hpp"

namespace saccade {

/// Straight lines between configurations, the first being the start. Empty, or one configuration: no motion.
using JointPath = std::vector<Configuration>;

/// A motion with constant accelerations on each of its pieces: continuous in position and speed, at rest in the
/// beginning and at the end.
class Trajectory {
 public:
  struct Piece {
    double duration_s{0.0};
    Configuration q;             ///< at its beginning
    Configuration speed;         ///< at its beginning, rad/s or m/s
    Configuration acceleration;  ///< rad/s² or m/s²
  };
  struct State {
    Configuration q;
    Configuration speed;
  };

  Trajectory() = default;
  explicit Trajectory(std::vector<Piece> pieces);

  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
  [[nodiscard]] bool empty() const { return pieces_.empty(); }
  [[nodiscard]] double duration_s() const { return begins_s_.empty() ? 0.0 : begins_s_.back(); }
  /// Before the beginning and after the end the arm stands still. Expects a trajectory that is not empty. O(log pieces)
  [[nodiscard]] State at(double t_s) const;
  /// The last configuration.
  [[nodiscard]] Configuration end() const { return at(duration_s()).q; }

 private:
  std::vector<Piece> pieces_;
  std::vector<double> begins_s_;  ///< of each piece, and the end
};

/// Whether the arm is free all along a piece of a trajectory.
using PieceIsFree = std::function<bool(const Trajectory::Piece& piece)>;

/// On every straight line all joints start, cruise and brake together, the slowest at its limit. At an inner
/// configuration, where `is_free` says that a parabola which cuts the corner is free, the arm turns without stopping;
/// elsewhere, and with no `is_free`, it stops there. A parabola takes no more than half of the lines beside it, both
/// together are never slower than stopping. Configurations within 1e-12 of the one before are passed over. The last
/// configuration is met to rounding.
/// O(configurations) and as many calls of is_free, or a few times as many.
[[nodiscard]] Trajectory parametrise(const ArmModel& arm, const JointPath& path, const PieceIsFree& is_free = {});

/// Seconds of parametrise without is_free: every line from rest to rest. O(configurations)
[[nodiscard]] double rest_to_rest_s(const ArmModel& arm, const Configuration& from, const Configuration& to);
[[nodiscard]] double rest_to_rest_s(const ArmModel& arm, const JointPath& path);

}  // namespace saccade
