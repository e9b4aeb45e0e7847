// SPDX-License-Identifier: Apache-2.0
#include "experiments/exploration_snapshots.hpp"

#include "experiments/picture_rows.hpp"
#include "text.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> exploration_snapshots(Explorations& all, std::size_t scene, const std::string& number,
                                              const TableOptions& options, const Executor& executor,
                                              const Progress& progress) {
  SACCADE_TRY(const Exploration* found, exploration(options, executor, progress, all, scene));
  ReproducedTable table;
  table.caption = "Fig. " + number + ": the views of experiment " + std::to_string(scene + 1) + " (" +
                  kTabletops.at(scene) + ") by " + all.strategy;
  table.columns = {"view",      "looks at an object",          "saliency of its segment",      "candidates",
                   "evaluated", "unknown voxels near objects", "share of the objects' surface"};
  nlohmann::json rows = nlohmann::json::array();
  const Measures& scan = found->run.scan.measures;
  table.rows.push_back({"scan", "–", "–", "–", "–", std::to_string(scan.unknown_near_objects.value_or(0)),
                        percent(scan.coverage.value_or(0.0))});
  for (const ViewRecord& view : found->run.views) {
    const bool looks = view.looks_at_object.value_or(false);
    const std::size_t unknown = view.measures.unknown_near_objects.value_or(0);
    const double coverage = view.measures.coverage.value_or(0.0);
    table.rows.push_back({std::to_string(table.rows.size()), looks ? "yes" : "no",
                          view.attention ? fixed(view.attention->saliency, 3) : "–", std::to_string(view.candidates),
                          std::to_string(view.evaluated), std::to_string(unknown), percent(coverage)});
    rows.push_back({{"looks_at_object", looks},
                    {"saliency", view.attention ? nlohmann::json(view.attention->saliency) : nlohmann::json(nullptr)},
                    {"candidates", view.candidates},
                    {"evaluated", view.evaluated},
                    {"unknown_near_objects", unknown},
                    {"coverage", coverage}});
  }
  table.notes = {
      "The thesis shows pictures without figures. The rows of the picture here: the surface by its saliency, where the "
      "strategy looks for objects, the chosen view among its candidates, and the map after each view with "
      "unknown space nearly black."};
  add_exploration_notes(options, table);
  table.figures = {{"scene", kTabletops.at(scene)}, {"strategy", all.strategy}, {"rows", std::move(rows)}};
  if (!options.draws) return table;
  const ExplorationPictures& drawn = found->pictures;
  std::vector<ColorImage> maps = drawn.maps;
  if (!maps.empty()) maps.erase(maps.begin());  // the scan, which the other rows have no picture of
  table.pictures.push_back(
      {"fig-" + number.substr(0, 1) + "-" + number.substr(2) + ".png",
       picture_rows(
           {{"saliency before view", drawn.saliencies}, {"view", drawn.candidates}, {"map after view", maps}})});
  return table;
}

}  // namespace saccade::reproduce
