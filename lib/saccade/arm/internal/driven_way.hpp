// SPDX-License-Identifier: Apache-2.0
#pragma once
// DrivenWay: the way that an arm came, and back along it out of a contact that was only seen afterwards.

#include <optional>
#include <vector>

#include "saccade/arm/arm_collision.hpp"
#include "saccade/robot/trajectory.hpp"

namespace saccade {

/// What an arm has driven, from rest to rest, each motion from where the one before ended. The last kMostPieces pieces.
class DrivenWay {
 public:
  void add(const Trajectory& motion);
  void clear() { pieces_.clear(); }

  /// From `q`, where the arm stands, back along the way, at the speeds that it came with, to the first place of rest at
  /// which it touches nothing. On the way it touches no cell that it does not touch where it stands, no link reaches
  /// deeper into obstacles than there, and one that has come free touches nothing again. Looked at in steps of
  /// max_step_m, and of SweptCells::kMargin_m. O(length of the way · balls), milliseconds.
  /// @return nullopt where there is no such way, or q is more than 0.01 rad, or m, off its end.
  [[nodiscard]] std::optional<Trajectory> back_from(const Configuration& q, const ArmCollision& collision,
                                                    const ObstacleMap& obstacles) const;

  static constexpr std::size_t kMostPieces{1000};

 private:
  std::vector<Trajectory::Piece> pieces_;
};

/// How far the balls of each link reach into obstacles at most, metres; 0: not at all. A ball whose centre is in an
/// obstacle counts with its radius. The base is not looked at.
[[nodiscard]] std::vector<double> obstacle_depths_m(const Configuration& q, const ArmCollision& collision,
                                                    const ObstacleMap& obstacles);

}  // namespace saccade
