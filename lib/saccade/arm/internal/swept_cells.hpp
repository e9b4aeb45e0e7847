// SPDX-License-Identifier: Apache-2.0
#pragma once
// SweptCells: the obstacle cells that an arm passes through.

#include <vector>

#include "saccade/arm/arm_collision.hpp"
#include "saccade/robot/trajectory.hpp"

namespace saccade {

/// Collector of cells of the map, without fixtures. Both arguments must outlive it.
class SweptCells {
 public:
  static constexpr double kMargin_m{0.005};

  SweptCells(const ArmCollision& collision, const ObstacleMap& obstacles, double margin_m = kMargin_m);

  /// Adds the cells within the margin of the arm. If they were free, the arm would touch no cell.
  void add(const Configuration& q);
  /// Adds the cells along a trajectory, in steps in which no point of the arm moves farther than kMargin_m.
  void add(const Trajectory& trajectory);

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::vector<Box> boxes() const;

 private:
  void add_cells(const Eigen::Vector3d& center_world, double radius_m);
  const ArmCollision& collision_;
  const ObstacleMap& obstacles_;
  double margin_m_;
  std::size_t count_{0};
  std::vector<bool> swept_;  ///< per cell of the map's box, x fastest
};

}  // namespace saccade
