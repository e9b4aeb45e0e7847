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

}  // namespace saccade
