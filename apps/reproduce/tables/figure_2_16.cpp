// SPDX-License-Identifier: Apache-2.0
// Fig. 2.16: the hand's trajectory in the map, what was found on it, and the regions that become unknown.
#include <algorithm>

#include "experiments/experiments.hpp"
#include "saccade/report/sheet.hpp"
#include "tables.hpp"
#include "text.hpp"

namespace saccade::reproduce {

using nlohmann::json;

Result<ReproducedTable> figure_2_16(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                    const Progress& progress) {
  SACCADE_CHECK(carry_out_updates(options, executor, progress, experiments.updates));
  ReproducedTable table;
  table.caption = "Fig. 2.16: the user's hand and the regions of interest of both experiments";
  table.columns = {"experiment",
                   "samples",
                   "Gaussians",
                   "points of interest, thesis",
                   "here",
                   "distance from the true places, cm",
                   "unknown voxels per region"};
  json rows = json::array();
  Sheet sheet{"Hand and regions of interest (thesis Fig. 2.16)", {}, ""};
  for (std::size_t i = 0; i < kUpdateExperiments.size(); ++i) {
    if (kUpdateExperiments.at(i).fuse_when != FuseWhen::viewpoints) continue;  // the hand is the same in both
    const OurUpdate& update = experiments.updates->at(i);
    const std::string name = std::to_string(kUpdateExperiments.at(i).number) + ", " + kUpdateExperiments.at(i).scene;
    std::string off, unknown;
    for (const double off_m : update.off_m) off += (off.empty() ? "" : ", ") + fixed(100.0 * off_m, 1);
    std::vector<std::size_t> voxels;
    for (const auto& of_region : update.unknown) voxels.push_back(of_region.front());
    for (const std::size_t count : voxels) unknown += (unknown.empty() ? "" : ", ") + std::to_string(count);
    table.rows.push_back({name, std::to_string(update.samples),
                          update.gaussians == 0 ? "none" : std::to_string(update.gaussians), i == 0 ? "1" : "3",
                          std::to_string(update.off_m.size()), off, unknown});
    rows.push_back({{"experiment", kUpdateExperiments.at(i).number},
                    {"samples", update.samples},
                    {"gaussians", update.gaussians},
                    {"distance_m", update.off_m},
                    {"unknown", voxels}});
    if (!options.draws) continue;
    sheet.panels.push_back({update.pictures.hand, "experiment " + name + ": the hand", {}, {}, {}});
    sheet.panels.push_back({update.pictures.forgotten, "its regions, unknown", {}, {}, {}});
  }
  table.notes = {
      "The detector is the one that Saccade uses by default, which fits no Gaussians; with --as-printed it is GMM-AS, "
      "as "
      "in the thesis, and the picture shows its Gaussians."};
  add_update_notes(options, experiments.updates->front(), table);
  table.figures = {{"rows", std::move(rows)}};
  if (options.draws) table.pictures.push_back({"fig-2-16.png", compose(sheet)});
  return table;
}

}  // namespace saccade::reproduce
