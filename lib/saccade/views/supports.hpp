// SPDX-License-Identifier: Apache-2.0
#pragma once
// Support: a surface that things stand on; Wall: one that they stand in front of.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace saccade {

/// A table, a floor, a board of a shelf: a plane, level or nearly, of occupied voxels with empty ones above. Columns
/// are counted in a grid over the map's workspace, x fastest.
struct Support {
  std::int32_t top{0};                                ///< first layer of voxels above its middle
  double height_m{0.0};                               ///< world z of its middle
  Eigen::Vector2d middle_m{Eigen::Vector2d::Zero()};  ///< world x and y
  Eigen::Vector2d slope{Eigen::Vector2d::Zero()};     ///< rise per metre along world x and y
  double area_m2{0.0};                                ///< that was seen
  std::vector<std::uint8_t> columns{};                ///< 1: within the convex hull of what was seen, and no hole

  /// World z of its plane at a place.
  [[nodiscard]] double height_at(const Eigen::Vector2d& p_m) const { return height_m + slope.dot(p_m - middle_m); }
};

/// An upright plane that things stand in front of or hang on. Nothing is expected behind it.
struct Wall {
  Eigen::Vector2d normal{Eigen::Vector2d::UnitX()};  ///< world x and y, towards the side that was seen
  double offset_m{0.0};                              ///< normal · (x, y) of its surface
  double area_m2{0.0};                               ///< that was seen
  double begin_m{0.0};                               ///< least along_m of what was seen, with a margin
  double end_m{0.0};                                 ///< greatest
  double low_m{0.0};                                 ///< world z of its lower edge
  double high_m{0.0};                                ///< world z of its upper edge

  /// Place along the wall, to the left seen from its front.
  [[nodiscard]] double along_m(const Eigen::Vector2d& p_m) const { return normal.x() * p_m.y() - normal.y() * p_m.x(); }
  /// Distance in front of its surface; negative behind it.
  [[nodiscard]] double in_front_m(const Eigen::Vector2d& p_m) const { return normal.dot(p_m) - offset_m; }
  /// Whether a place lies in front of or behind the seen part, not beside it.
  [[nodiscard]] bool faces(const Eigen::Vector3d& p_m) const {
    const double along = along_m(p_m.head<2>());
    return along >= begin_m && along <= end_m && p_m.z() >= low_m && p_m.z() <= high_m;
  }
};

}  // namespace saccade
