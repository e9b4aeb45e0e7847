// SPDX-License-Identifier: Apache-2.0
// Fig. 2.20: unknown voxels in each region after the user's task and after each view.
#include <algorithm>

#include "experiments/experiments.hpp"
#include "saccade/report/plot.hpp"
#include "tables.hpp"
#include "text.hpp"

namespace saccade::reproduce {
namespace {

Plot plot_of(const ThesisExperiment& thesis, const OurUpdate& update) {
  Plot plot;
  plot.title = "Unknown voxels in each region, experiment " + std::to_string(thesis.number) + ", " +
               thesis_name(thesis.fuse_when) + " (thesis Fig. 2.20)";
  plot.x_label = "views after the task";
  plot.y_label = "unknown voxels";
  plot.min_x_step = 1.0;
  double most = 1.0;
  for (std::size_t region = 0; region < update.unknown.size(); ++region) {
    PlotSeries series{"region " + std::to_string(region + 1), {}, {}};
    for (std::size_t view = 0; view < update.unknown[region].size(); ++view) {
      series.x.push_back(static_cast<double>(view));
      series.y.push_back(static_cast<double>(update.unknown[region][view]));
      most = std::max(most, series.y.back());
    }
    plot.series.push_back(std::move(series));
  }
  plot.y_range = {0.0, most};
  return plot;
}

}  // namespace

Result<ReproducedTable> figure_2_20(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                    const Progress& progress) {
  SACCADE_CHECK(carry_out_updates(options, executor, progress, experiments.updates));
  ReproducedTable table;
  table.caption = "Fig. 2.20: unknown voxels in each region, after the task (U) and after each view";
  table.columns = {"experiment", "frames fused", "region", "U, then after each view"};
  nlohmann::json rows = nlohmann::json::array();
  for (std::size_t i = 0; i < kUpdateExperiments.size(); ++i) {
    const ThesisExperiment& thesis = kUpdateExperiments.at(i);
    const OurUpdate& update = experiments.updates->at(i);
    const std::string name = std::to_string(thesis.number) + ", " + thesis.scene;
    for (std::size_t region = 0; region < update.unknown.size(); ++region) {
      std::string counts;
      for (const std::size_t count : update.unknown[region]) {
        counts += (counts.empty() ? "" : " → ") + std::to_string(count);
      }
      table.rows.push_back({name, thesis_name(thesis.fuse_when), std::to_string(region + 1), counts});
      rows.push_back({{"experiment", thesis.number},
                      {"fuse_when", to_string(thesis.fuse_when)},
                      {"region", region + 1},
                      {"unknown", update.unknown[region]}});
    }
    if (!options.draws) continue;
    table.plots.push_back({"fig-2-20-" + std::string{thesis.scene} + "-" +
                               (thesis.fuse_when == FuseWhen::viewpoints ? "viewpoints" : "motion") + ".svg",
                           plot_svg(plot_of(thesis, update))});
  }
  table.notes = {
      "The thesis shows curves without figures: unknown voxels become fewer with each view and never none, for the "
      "inside of objects stays unknown; fused in motion (KFOM), later regions are seen on the way to the first."};
  add_update_notes(options, experiments.updates->front(), table);
  table.figures = {{"rows", std::move(rows)}};
  return table;
}

}  // namespace saccade::reproduce
