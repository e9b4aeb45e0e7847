// SPDX-License-Identifier: Apache-2.0
#pragma once
// SweptCells: the obstacle cells that an arm goes through.

#include <vector>

#include "saccade/robot/arm_collision.hpp"
#include "saccade/robot/trajectory.hpp"

namespace saccade {

/// Gathers cells of the map, not fixtures. Both arguments outlive it.
class SweptCells {
 public:
  SweptCells(const ArmCollision& collision, const ObstacleMap& obstacles);

  /// The cells that the arm comes within kMargin_m of: were they free, the arm would touch no cell.
  void add(const Configuration& q);
  /// The same all along, in steps in which no point of the arm moves farther than kMargin_m.
  void add(const Trajectory& trajectory);

  [[nodiscard]] std::vector<Box> boxes() const;

  static constexpr double kMargin_m{0.005};

 private:
  void add_cells(const Eigen::Vector3d& center_world, double radius_m);
  const ArmCollision& collision_;
  const ObstacleMap& obstacles_;
  std::vector<bool> swept_;  ///< per cell of the map's box, x fastest
};

}  // namespace saccade
