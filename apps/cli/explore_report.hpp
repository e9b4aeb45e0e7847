// SPDX-License-Identifier: Apache-2.0
#pragma once
// The pictures of an exploration, drawn after each view, and the page that shows them at the end.

#include <nlohmann/json.hpp>
#include <string>

#include "explore_devices.hpp"
#include "run_folder.hpp"
#include "saccade/report/robot_drawing.hpp"
#include "saccade/report/run_report.hpp"

namespace saccade::cli {

/// What there is to draw of one view. The references outlive the call.
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
};

/// Writes view-NN-choice.png, view-NN-seen.png and view-NN-map.png, and view-NN-saliency.png of a strategy that looks
/// for objects. io_failure.
[[nodiscard]] Status draw_view(const RunFolder& out, const ViewScenes& scenes, const Executor& executor);
/// Writes view-00-map.png.
[[nodiscard]] Status draw_scan(const RunFolder& out, const TsdfSnapshot& map, const Box& workspace,
                               const Executor& executor, const RobotDrawing* robot = nullptr);
/// Of a view of a run: a picture, what it was chosen from, the map after it.
[[nodiscard]] bool is_view_file(const std::string& file_name);

/// A view for the page, with the pictures that draw_view made of it.
[[nodiscard]] ShownView shown_view(const RunFolder& out, const ViewRecord& view, std::size_t number);
/// "the best view left promises 12.3 cm², 14.0 would be worth the move"; empty where a run ended for another reason.
[[nodiscard]] std::string end_text(const RunRecord& run, const std::string& gain_unit);
/// "640 × 480, f = 525 px, 0.5–2 m", from the document.
[[nodiscard]] std::string camera_text(const nlohmann::json& camera);

/// Writes report.html from the record, the document that goes to run.json and the pictures in the folder; pictures that
/// are not there are left out. io_failure.
[[nodiscard]] Status write_report(const RunFolder& out, const RunRecord& run, const Measures& final,
                                  const nlohmann::json& document, const ExploreOptions& options);

}  // namespace saccade::cli
