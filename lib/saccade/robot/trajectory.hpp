// SPDX-License-Identifier: Apache-2.0
#pragma once
// Trajectory: where the joints of an arm are at which time.

#include <vector>

#include "saccade/robot/configuration.hpp"

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

}  // namespace saccade
