// SPDX-License-Identifier: Apache-2.0
// Fig. 3.23: a Kinect v2's depth after each filter, outliers in red.
#include "experiments/experiments.hpp"
#include "saccade/report/depth_picture.hpp"
#include "saccade/report/sheet.hpp"
#include "tables.hpp"

namespace saccade::reproduce {
namespace {

/// The first frame after a filter; what counts, and lies on no plane, is red.
struct DrawnFrame {
  ColorImage picture;
  std::size_t measurements{0};
  std::size_t outliers{0};
};

DrawnFrame draw_frame(const FilteredFrames& frames, const DepthImage& depth) {
  DrawnFrame drawn{depth_picture(depth, {0.7, 2.2}), 0, 0};
  for (int v = 0; v < frames.camera.height; ++v) {
    for (int u = 0; u < frames.camera.width; ++u) {
      if (!(depth(u, v) > 0.0F)) continue;
      const Eigen::Vector3d p_camera = frames.camera.ray(u, v) * static_cast<double>(depth(u, v));
      const Eigen::Vector3d p_world = frames.scene.T_world_camera * p_camera;
      if (!contains(frames.scene.workspace, p_world)) {
        drawn.picture(u, v) = kNoReturn;
        continue;
      }
      ++drawn.measurements;
      if (thesis::distance_from_planes(frames.scene, p_world) <= thesis::kPlaneDistance_m) continue;
      ++drawn.outliers;
      drawn.picture(u, v) = Rgb8{255, 0, 0};
    }
  }
  return drawn;
}

}  // namespace

Result<ReproducedTable> figure_3_23(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                    const Progress& progress) {
  SACCADE_CHECK(carry_out_filters(options, executor, progress, experiments.filtered_frames));
  const FilteredFrames& frames = *experiments.filtered_frames;
  ReproducedTable table;
  table.caption = "Fig. 3.23: one frame after each filter; points on no plane are outliers";
  table.columns = {"filter", "measurements", "outliers"};
  nlohmann::json rows = nlohmann::json::array();
  Sheet sheet{"One frame after each filter (thesis Fig. 3.23)", {}, "red: farther than 3 cm from every plane"};
  for (std::size_t i = 0; i < kPipelines.size(); ++i) {
    DrawnFrame drawn = draw_frame(frames, frames.by_pipeline.at(i).front());
    table.rows.push_back({kPipelines.at(i).here, std::to_string(drawn.measurements), std::to_string(drawn.outliers)});
    rows.push_back(
        {{"pipeline", kPipelines.at(i).here}, {"measurements", drawn.measurements}, {"outliers", drawn.outliers}});
    sheet.panels.push_back({std::move(drawn.picture), kPipelines.at(i).here, {}, {}, {}});
  }
  table.notes = {
      "The thesis shows the mean of 30 frames, whose figures are Table 3.4; here it is the first of them, which has "
      "more "
      "outliers. The scene is simulated; shadows fall to the right of things (Table 3.4 says why)."};
  table.figures = {{"rows", std::move(rows)}};
  if (options.draws) table.pictures.push_back({"fig-3-23.png", compose(sheet)});
  return table;
}

}  // namespace saccade::reproduce
