// SPDX-License-Identifier: Apache-2.0
#pragma once
// ReachScene and reach_picture: what share of view poses an arm can take, over a workspace and by direction.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "saccade/core/region.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

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
