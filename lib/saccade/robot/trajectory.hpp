// SPDX-License-Identifier: Apache-2.0
#pragma once
// Configuration: where the joints of an arm are; Trajectory: where they are at which time.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace saccade {

/// Joints that an arm has at most. Arms have six or seven, a rail or a torso under them adds one or two; with a bound,
/// configurations and Jacobians need no heap.
constexpr int kMaxJoints{12};

/// One value per joint, base first: radians, for prismatic joints metres. Eigen's dynamic vector in its own storage:
/// copying one, or a vector of them, allocates nothing per element.
using Configuration = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxJoints, 1>;

/// Straight lines between configurations, the first being the start. Empty, or one configuration: no motion.
using JointPath = std::vector<Configuration>;

/// What an observer of a motion says at each sample.
enum class Advance : std::uint8_t { go_on, stop };

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
