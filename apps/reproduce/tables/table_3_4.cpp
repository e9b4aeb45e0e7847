// SPDX-License-Identifier: Apache-2.0
// Table 3.4: what filters of a Kinect v2's depth images leave of its wrong points, in simulation.
#include "experiments/experiments.hpp"
#include "tables.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;
using thesis::AverageScore;

std::string or_dash(int count) { return count > 0 ? std::to_string(count) : "–"; }

}  // namespace

Result<ReproducedTable> table_3_4(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                  const Progress& progress) {
  SACCADE_CHECK(carry_out_filters(options, executor, progress, experiments.filtered_frames));
  const FilteredFrames& frames = *experiments.filtered_frames;
  ReproducedTable table;
  table.caption = "Table 3.4: measurements, and outliers among them, after each filter";
  table.columns = {"thesis", "measurements", "outliers", "here", "measurements", "outliers"};
  json rows = json::array();
  for (std::size_t i = 0; i < kPipelines.size(); ++i) {
    const Pipeline& pipeline = kPipelines.at(i);
    const AverageScore score = thesis::score_average(frames.scene, frames.camera, frames.by_pipeline.at(i));
    table.rows.push_back({pipeline.name, or_dash(pipeline.measurements), or_dash(pipeline.outliers), pipeline.here,
                          std::to_string(score.measurements), std::to_string(score.outliers)});
    rows.push_back({{"pipeline", pipeline.here},
                    {"thesis_measurements", pipeline.measurements},
                    {"thesis_outliers", pipeline.outliers},
                    {"measurements", score.measurements},
                    {"outliers", score.outliers}});
  }
  table.notes = {
      "Simulated: a table with a box of 16 × 24 × 30 cm and a board behind it, planes only, seen from 75 cm above the "
      "table and about 1 m before the box. Mean of " +
          std::to_string(thesis::kAveragedFrames) +
          " frames, each filtered first; a pixel counts where half of them have a return, and its mean is an outlier "
          "farther than 3 cm from every plane. Points behind the table are cut off, as in the thesis.",
      "The emitter is 8 cm to the left of the camera (eq. 3.15), so shadows fall to the right of things; in the "
      "thesis' "
      "Fig. 3.23 they are on the left, as in drivers that mirror the image (--emitter right of saccade filter).",
      "The driver's bilateral and edge-aware filters work on what the sensor measures before depth is made of it. Here "
      "they are filters of depth: a mean weighted by distance and depth (5 pixels across, 3 cm), and the removal of "
      "points with more than five of eight neighbours nearer by 5 cm or farther by 3 cm.",
      "Points that the emitter does not light are measured 5 cm too far with a standard deviation of 10 cm: ours to "
      "choose; outliers compare between rows, not with the thesis."};
  table.figures = {{"rows", std::move(rows)}, {"frames", thesis::kAveragedFrames}};
  return table;
}

}  // namespace saccade::reproduce
