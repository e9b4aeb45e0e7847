// SPDX-License-Identifier: Apache-2.0
// Fig. 3.22: the map of all four experiments after five views, by attention and by the standard method.
#include "experiments/experiments.hpp"
#include "experiments/picture_rows.hpp"
#include "tables.hpp"
#include "text.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_3_22(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                    const Progress& progress) {
  ExplorationExperiments& all = experiments.explorations;
  ReproducedTable table;
  table.caption = "Fig. 3.22: the map after five views, by attention / by the standard method";
  table.columns = {"experiment", "unknown voxels near objects", "share of the objects' surface",
                   "unknown voxels in all"};
  nlohmann::json rows = nlohmann::json::array();
  std::vector<PictureRow> pictures{{"attention, experiment", {}}, {"standard, experiment", {}}};
  for (std::size_t scene = 0; scene < kTabletops.size(); ++scene) {
    std::vector<std::string> row{std::to_string(scene + 1) + ", " + kTabletops.at(scene), "", "", ""};
    std::size_t of_strategy = 0;
    for (Explorations* runs : {&all.attention, &all.standard}) {
      progress.report("explorations", 2 * scene + of_strategy, 2 * kTabletops.size());
      SACCADE_TRY(const Exploration* found, exploration(options, executor, progress, *runs, scene));
      const Measures& end = found->run.final();
      const std::string between = of_strategy == 0 ? "" : " / ";
      row[1] += between + std::to_string(end.unknown_near_objects.value_or(0));
      row[2] += between + percent(end.coverage.value_or(0.0));
      row[3] += between + std::to_string(end.unknown_left);
      rows.push_back({{"scene", kTabletops.at(scene)},
                      {"strategy", runs->strategy},
                      {"unknown_near_objects", end.unknown_near_objects.value_or(0)},
                      {"coverage", end.coverage.value_or(0.0)},
                      {"unknown_left", end.unknown_left}});
      if (options.draws) pictures[of_strategy].pictures.push_back(found->pictures.maps.back());
      ++of_strategy;
    }
    table.rows.push_back(std::move(row));
  }
  table.notes = {
      "The thesis shows pictures without figures, and says that objects are more complete by its method, and the space "
      "around the back panel by the standard one."};
  add_exploration_notes(options, table);
  table.figures = {{"rows", std::move(rows)}};
  if (options.draws) table.pictures.push_back({"fig-3-22.png", picture_rows(pictures)});
  return table;
}

}  // namespace saccade::reproduce
