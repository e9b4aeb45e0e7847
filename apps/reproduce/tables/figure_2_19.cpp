// SPDX-License-Identifier: Apache-2.0
// Fig. 2.19: the map at the end of both experiments, frames fused at viewpoints alone and in motion too.
#include "experiments/experiments.hpp"
#include "saccade/report/sheet.hpp"
#include "tables.hpp"
#include "text.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_2_19(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                    const Progress& progress) {
  SACCADE_CHECK(carry_out_updates(options, executor, progress, experiments.updates));
  ReproducedTable table;
  table.caption = "Fig. 2.19: the map at the end of both experiments";
  table.columns = {"experiment", "frames fused", "views", "unknown voxels in the regions",
                   "least share of a region's surface"};
  nlohmann::json rows = nlohmann::json::array();
  Sheet sheet{"The map at the end (thesis Fig. 2.19)", {}, "unknown nearly black"};
  for (std::size_t i = 0; i < kUpdateExperiments.size(); ++i) {
    const ThesisExperiment& thesis = kUpdateExperiments.at(i);
    const OurUpdate& update = experiments.updates->at(i);
    std::size_t unknown = 0;
    for (const auto& of_region : update.unknown) unknown += of_region.back();
    const std::string name = std::to_string(thesis.number) + ", " + thesis.scene;
    table.rows.push_back({name, thesis_name(thesis.fuse_when), std::to_string(update.views), std::to_string(unknown),
                          percent(update.coverage)});
    rows.push_back({{"experiment", thesis.number},
                    {"fuse_when", to_string(thesis.fuse_when)},
                    {"views", update.views},
                    {"unknown", unknown},
                    {"coverage", update.coverage}});
    if (options.draws)
      sheet.panels.push_back({update.pictures.after, name + ", " + thesis_name(thesis.fuse_when), {}, {}, {}});
  }
  table.notes = {"The thesis shows pictures without figures. Unknown voxels inside objects stay unknown."};
  add_update_notes(options, experiments.updates->front(), table);
  table.figures = {{"rows", std::move(rows)}};
  if (options.draws) table.pictures.push_back({"fig-2-19.png", compose(sheet)});
  return table;
}

}  // namespace saccade::reproduce
