// SPDX-License-Identifier: Apache-2.0
#pragma once
// Configuration: joint positions of an arm. Trajectory: joint positions over time.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace saccade {

/// Largest number of joints of an arm. Arms have six or seven joints; a rail or a torso adds one or two. The bound
/// keeps configurations and Jacobians off the heap.
constexpr int kMaxJoints{12};

/// One value per joint, base first: radians, or metres for prismatic joints. An Eigen vector with its own storage, so
/// that copies allocate nothing.
using Configuration = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxJoints, 1>;

/// Straight lines between configurations, beginning with the start. Empty, or a single configuration: no motion.
using JointPath = std::vector<Configuration>;

/// Answer of a motion's observer to each sample.
enum class Advance : std::uint8_t { go_on, stop };

/// Motion in pieces of constant acceleration: continuous in position and speed, at rest in the beginning and at the
/// end.
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
  /// Returns the state at a time; at rest before the beginning and after the end. Expects a trajectory that is not
  /// empty. O(log pieces)
  [[nodiscard]] State at(double t_s) const;
  /// Returns the last configuration.
  [[nodiscard]] Configuration end() const { return at(duration_s()).q; }

 private:
  std::vector<Piece> pieces_;
  std::vector<double> begins_s_;  ///< beginning of each piece, then the end
};

}  // namespace saccade
