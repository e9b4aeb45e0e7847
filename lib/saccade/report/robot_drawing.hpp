// SPDX-License-Identifier: Apache-2.0
#pragma once
// RobotDrawing: an arm and the way of its camera, as pictures of the map show them.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/report/canvas.hpp"

namespace saccade {

/// World frame. What is empty is not drawn.
struct RobotDrawing {
  TriangleMesh arm;                               ///< arm_mesh, in the configuration at the end of the path
  std::vector<Eigen::Vector3d> p_world_path{};    ///< the camera's centres on its way, in order
  std::optional<Eigen::Vector3d> p_world_base{};  ///< in the picture, which is taken from beside it: azimuth_beside
  std::vector<Eigen::Vector3d> p_world_shown{};   ///< in the picture too; give the same in all pictures of a run
  double opacity{1.0};                            ///< of the arm, in [0, 1]; below 1 the map is seen through it
};

/// Adds the arm, hidden by what is already drawn nearer, and the path as a line with a dot at its start; where it is
/// hidden it is faint. The same picture for every thread count. O(triangles + covered pixels).
void draw_robot(Canvas& canvas, const RobotDrawing& robot, const Executor& executor);

/// The path's colour.
[[nodiscard]] Rgb8 path_color();

/// Azimuth for OverviewConfig, nearest to the one given, from which an arm does not stand before the middle of what is
/// shown: at least 100° from where its base is.
[[nodiscard]] double azimuth_beside(const Eigen::Vector3d& p_world_base, const Eigen::Vector3d& p_world_middle,
                                    double azimuth_rad);

/// overview_of the points and of those that the robot wants shown, from beside its base; without a robot (null), of the
/// points alone.
[[nodiscard]] Viewpoint overview_with(const RobotDrawing* robot, std::vector<Eigen::Vector3d> points_world,
                                      const Eigen::Vector3d& p_world_middle, OverviewConfig config);

}  // namespace saccade
