// SPDX-License-Identifier: Apache-2.0
#pragma once
// seen_picture, candidates_picture, map_picture: what a view of an exploration saw, among which candidates it was
// chosen, and the map after it.

#include <span>
#include <string>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/report/depth_picture.hpp"
#include "saccade/report/drawn_surfels.hpp"
#include "saccade/report/robot_drawing.hpp"
#include "saccade/report/view_picture.hpp"
#include "saccade/sensor/camera.hpp"

namespace saccade {

/// Colour, where the frame has it, beside depth with its scale; each `panel_width` pixels wide, or as wide as the frame
/// if that is less. Expects depth, and colour of the same size.
[[nodiscard]] ColorImage seen_picture(const Frame& frame, const DepthScale& scale, int panel_width = 480);

/// Candidates from which a view was chosen.
struct CandidatesScene {
  const TsdfSnapshot& map;  ///< before the move
  Region region;
  std::span<const ScoredPose> candidates;  ///< in any order; a gain that is NaN: not evaluated
  Pose T_world_chosen{Pose::Identity()};
  std::span<const Pose> T_world_earlier;  ///< views taken before
  const RobotDrawing* robot{nullptr};     ///< drawn into the map; not owned
  const DrawnSurfels* surfels{nullptr};   ///< drawn instead of the map; not owned
};

struct CandidatesPictureConfig {
  std::string gain_unit{"rays"};
  PinholeCamera sensor;  ///< shape of the frusta
  OverviewConfig overview{.width = 720, .height = 540};
  double margin_m{0.1};  ///< shown around the candidates and the region
  int samples{1};        ///< rays through the map per pixel and direction
};

/// The map around the region as seen from outside, cut to what lies among the candidates, as in view_picture; every
/// candidate's place in the colour of the best gain there, the chosen view as a frustum, earlier ones as thin grey
/// ones. The thread count does not change the picture.
[[nodiscard]] ColorImage candidates_picture(const CandidatesScene& scene, const Executor& executor,
                                            const CandidatesPictureConfig& config = {});

struct MapPictureConfig {
  OverviewConfig overview{.width = 720, .height = 540};
  double margin_m{0.1};                  ///< shown around the box
  int samples{1};                        ///< per pixel and direction
  const RobotDrawing* robot{nullptr};    ///< drawn into the map; not owned
  const DrawnSurfels* surfels{nullptr};  ///< drawn instead of the map; not owned
};

/// The map in a box, usually the workspace, as seen from outside; unknown as a veil. One place for one box and one
/// base of a robot, so that pictures of a run can be compared. The thread count does not
/// change the picture.
[[nodiscard]] ColorImage map_picture(const TsdfSnapshot& map, const Box& box, const Executor& executor,
                                     const MapPictureConfig& config = {});

}  // namespace saccade
