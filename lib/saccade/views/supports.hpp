// SPDX-License-Identifier: Apache-2.0
#pragma once
// Support: a surface that objects stand on. Wall: an upright plane behind them.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace saccade {

/// Table, floor or shelf board: a nearly level plane of occupied voxels with empty ones above. Columns are numbered in
/// a grid over the map's workspace, x fastest.
struct Support {
  std::int32_t top{0};                                ///< first layer of voxels above its middle
  double height_m{0.0};                               ///< world z of its middle
  Eigen::Vector2d middle_m{Eigen::Vector2d::Zero()};  ///< world x and y
  Eigen::Vector2d slope{Eigen::Vector2d::Zero()};     ///< rise per metre along world x and y
  double area_m2{0.0};                                ///< seen area
  std::vector<std::uint8_t> columns{};                ///< 1: within the convex hull of the seen part, and not a hole

  /// Returns the plane's world z at a point.
  [[nodiscard]] double height_at(const Eigen::Vector2d& p_m) const { return height_m + slope.dot(p_m - middle_m); }
};

/// Upright plane that objects stand in front of or hang on. Nothing is expected behind it.
struct Wall {
  Eigen::Vector2d normal{Eigen::Vector2d::UnitX()};  ///< world x and y, towards the side that was seen
  double offset_m{0.0};                              ///< normal · (x, y) of its surface
  double area_m2{0.0};                               ///< seen area
  double begin_m{0.0};                               ///< smallest along_m of the seen part, with a margin
  double end_m{0.0};                                 ///< largest along_m
  double low_m{0.0};                                 ///< world z of its lower edge
  double high_m{0.0};                                ///< world z of its upper edge

  /// Returns the position along the wall, increasing to the left as seen from its front.
  [[nodiscard]] double along_m(const Eigen::Vector2d& p_m) const { return normal.x() * p_m.y() - normal.y() * p_m.x(); }
  /// Returns the distance in front of the surface; negative behind it.
  [[nodiscard]] double in_front_m(const Eigen::Vector2d& p_m) const { return normal.dot(p_m) - offset_m; }
  /// Tells whether a point lies in front of or behind the seen part, not beside it.
  [[nodiscard]] bool faces(const Eigen::Vector3d& p_m) const {
    const double along = along_m(p_m.head<2>());
    return along >= begin_m && along <= end_m && p_m.z() >= low_m && p_m.z() <= high_m;
  }
};

}  // namespace saccade
