// SPDX-License-Identifier: Apache-2.0
// Fig. 4.4: the five scenes of surfels and their true segments.
#include <algorithm>

#include "experiments/experiments.hpp"
#include "experiments/picture_rows.hpp"
#include "saccade/report/segment_picture.hpp"
#include "saccade/report/surfel_picture.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_4_4(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                   const Progress& progress) {
  SACCADE_TRY(const DoneTrials trials, surfel_trials(options, executor, progress, experiments.surfels));
  ReproducedTable table;
  table.caption = "Fig. 4.4: the scenes and their true segments";
  table.columns = {"scene", "surfels", "true segments", "surfels without one"};
  nlohmann::json rows = nlohmann::json::array();
  std::vector<PictureRow> pictures{{"scene", {}}, {"true segments of scene", {}}};
  for (const DoneTrial& done : trials.done) {
    const thesis::SurfelTrial& trial = *done.trial;
    const auto unlabelled =
        static_cast<std::size_t>(std::count(trial.true_segments.begin(), trial.true_segments.end(), kUnlabelled));
    table.rows.push_back(
        {trial.scene, std::to_string(trial.surfels), std::to_string(trial.segments), std::to_string(unlabelled)});
    rows.push_back(
        {{"scene", trial.scene}, {"surfels", trial.surfels}, {"segments", trial.segments}, {"unlabelled", unlabelled}});
    if (!options.draws) continue;
    const PointCloud& cloud = trial.clouds.front();
    OverviewConfig overview;
    overview.width = 420;
    overview.height = 315;
    const Viewpoint view = overview_of_points(cloud.positions_m, overview);
    const SurfelDiscs discs{cloud.positions_m, cloud.normals, cloud.radii_m};
    const std::vector<Rgb8> palette = segment_colors(trial.segments);
    std::vector<Rgb8> own, of_segment;
    for (std::size_t i = 0; i < trial.true_segments.size(); ++i) {
      const std::uint32_t segment = trial.true_segments[i];
      own.push_back(byte_color(cloud.colors[i]));
      of_segment.push_back(segment == kUnlabelled ? Rgb8{110, 112, 118} : palette[segment]);
    }
    pictures[0].pictures.push_back(draw_surfels(discs, own, view, executor));
    pictures[1].pictures.push_back(draw_surfels(discs, of_segment, view, executor));
  }
  table.notes = {"The thesis shows pictures; its numbers of segments are in Table 4.1."};
  add_surfel_notes(options, false, table);
  mark_missing(trials.missing, table);
  table.figures = {{"rows", std::move(rows)}};
  if (options.draws) table.pictures.push_back({"fig-4-4.png", picture_rows(pictures)});
  return table;
}

}  // namespace saccade::reproduce
