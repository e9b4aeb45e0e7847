// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExecutedPath: the path that an arm has driven, and a retreat along it out of a contact that was only seen afterwards.

#include <optional>
#include <vector>

#include "saccade/arm/arm_collision.hpp"
#include "saccade/robot/trajectory.hpp"

namespace saccade {

/// Motions that an arm has driven, from rest to rest, each starting where the previous one ended. Keeps the last
/// kMostPieces pieces.
class ExecutedPath {
 public:
  void add(const Trajectory& motion);
  void clear() { pieces_.clear(); }

  /// Returns a trajectory from the arm's configuration `q` back along the path, at the original speeds, to the first
  /// place of rest without a contact. On the way the arm touches no cell that it does not touch at q, no link reaches
  /// deeper into obstacles than there, and a link that has come free touches nothing again. Checked in steps of
  /// max_step_m, and of SweptCells::kMargin_m. O(length of the path · balls), milliseconds.
  /// @return nullopt where there is no such retreat, or q is more than 0.01 rad, or m, from the path's end.
  [[nodiscard]] std::optional<Trajectory> retreat_from(const Configuration& q, const ArmCollision& collision,
                                                       const ObstacleMap& obstacles) const;

  static constexpr std::size_t kMostPieces{1000};

 private:
  std::vector<Trajectory::Piece> pieces_;
};

/// Returns how deep the balls of each link reach into obstacles, metres; 0: not at all. A ball whose centre is in an
/// obstacle counts with its radius. The base is ignored.
[[nodiscard]] std::vector<double> obstacle_depths_m(const Configuration& q, const ArmCollision& collision,
                                                    const ObstacleMap& obstacles);

}  // namespace saccade
