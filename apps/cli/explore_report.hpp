// SPDX-License-Identifier: Apache-2.0
#pragma once
// The pictures of an exploration, drawn after each view.

#include <string>

#include "explore_devices.hpp"
#include "run_folder.hpp"
#include "saccade/report/drawn_surfels.hpp"
#include "saccade/report/robot_drawing.hpp"

namespace saccade::cli {

/// Scenes to draw for one view. The references outlive the call.
struct ViewScenes {
  std::size_t number{1};  ///< 1 for the first view
  const TsdfSnapshot& before;
  const TsdfSnapshot& after;
  const ViewRecord& view;  ///< with its choice
  std::vector<Pose> T_world_earlier;
  std::span<const Frame> frames;  ///< frames of the oscillation
  const Box& workspace;
  PinholeCamera camera;
  const RobotDrawing* robot{nullptr};  ///< drawn at the view; none: the camera flies
  std::string gain_unit{"rays"};
  const DrawnSurfels* surfels_before{nullptr};  ///< drawn instead of the maps
  const DrawnSurfels* surfels_after{nullptr};
};

/// Writes view-NN-choice.png, view-NN-seen.png and view-NN-map.png, and view-NN-saliency.png of a strategy that looks
/// for objects. io_failure.
[[nodiscard]] Status draw_view(const RunFolder& out, const ViewScenes& scenes, const Executor& executor);
/// Writes view-00-map.png.
[[nodiscard]] Status draw_scan(const RunFolder& out, const TsdfSnapshot& map, const Box& workspace,
                               const Executor& executor, const RobotDrawing* robot = nullptr,
                               const DrawnSurfels* surfels = nullptr);
/// Whether the file belongs to a view of a run: a picture, its candidates, the map after it.
[[nodiscard]] bool is_view_file(const std::string& file_name);

/// "the best view left promises 12.3 cm², 14.0 would be worth the move"; empty where a run ended for another reason.
[[nodiscard]] std::string end_text(const RunRecord& run, const std::string& gain_unit);

}  // namespace saccade::cli
