// SPDX-License-Identifier: Apache-2.0
#pragma once
// RobotDrawing: an arm and the way of its camera, as pictures of the map show them; ReachScene and reach_picture: what
// share of view poses an arm can take, over a workspace and by direction.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/region.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/report/viewpoint.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

class Canvas;

/// World frame. What is empty is not drawn.
struct RobotDrawing {
  TriangleMesh arm;                             ///< arm_mesh, in the configuration at the end of the path
  std::vector<Eigen::Vector3d> p_world_path{};  ///< the camera's centres on its way, in order
  std::optional<Eigen::Vector3d>
      p_world_base{};   ///< pictures are taken from the side that it leaves free: azimuth_beside
  double opacity{1.0};  ///< the arm's, in [0, 1]; below 1 the map is seen through it
};

/// Adds the arm, hidden by what is already drawn nearer, and the path as a line with a dot at its start; where it is
/// hidden it is faint. The thread count does not change the picture. O(triangles + covered pixels).
void draw_robot(Canvas& canvas, const RobotDrawing& robot, const Executor& executor);

/// The path's colour.
[[nodiscard]] Rgb8 path_color();

/// Azimuth for OverviewConfig, nearest to the one given, from which an arm does not stand before the middle of what is
/// shown: at least 125° from where its base is.
[[nodiscard]] double azimuth_beside(const Eigen::Vector3d& p_world_base, const Eigen::Vector3d& p_world_middle,
                                    double azimuth_rad);

/// overview_of the points, from the side that the robot's base leaves free; the arm itself may reach out of the
/// picture.
[[nodiscard]] Viewpoint overview_with(const RobotDrawing* robot, std::vector<Eigen::Vector3d> points_world,
                                      const Eigen::Vector3d& p_world_middle, OverviewConfig config);

/// World frame, seen from above. Shares are in [0, 1].
struct ReachScene {
  /// A square of the grid.
  struct Square {
    Eigen::Vector2d middle;
    std::optional<double> share;  ///< none: not tested
  };
  /// Where cameras stand as seen from the points that they look at.
  struct Direction {
    double latitude_rad{0.0};
    double longitude_rad{0.0};
    double share{0.0};
  };

  std::string title;
  Box workspace;
  double square_m{0.05};
  std::vector<Square> squares;
  std::optional<Eigen::Vector2d> best;  ///< is marked
  std::vector<Direction> directions;    ///< equal steps of both; longitudes begin at 0 and go around
  std::vector<Box> fixtures;
  std::vector<std::vector<Eigen::Vector2d>> arm;  ///< points of each part, whose convex hull is drawn
  std::string note;                               ///< a line at the bottom
};

/// Two panels: the squares from above, x to the right, with workspace, fixtures and arm; and the sky, where the middle
/// is straight above and the rim level. Fixtures are cut at the panel's border. Expects at least one square.
[[nodiscard]] ColorImage reach_picture(const ReachScene& scene);

}  // namespace saccade
