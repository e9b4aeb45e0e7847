// SPDX-License-Identifier: Apache-2.0
#include "experiments/update_snapshots.hpp"

#include <algorithm>

#include "experiments/picture_rows.hpp"
#include "text.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> update_snapshots(std::size_t experiment, const std::string& number, const TableOptions& options,
                                         const Executor& executor, const Progress& progress,
                                         std::optional<UpdateExperiments>& all) {
  SACCADE_CHECK(carry_out_updates(options, executor, progress, all));
  const ThesisExperiment& thesis = kUpdateExperiments.at(experiment);
  const OurUpdate& update = all->at(experiment);
  ReproducedTable table;
  table.caption = "Fig. " + number + ": the views of experiment " + std::to_string(thesis.number) + " (" +
                  thesis.scene + "), " + thesis_name(thesis.fuse_when) + "; the thesis needed " +
                  std::to_string(thesis.views);
  table.columns = {"view", "chosen for region", "unknown voxels in it before", "after"};
  nlohmann::json rows = nlohmann::json::array();
  for (std::size_t view = 0; view < update.region_of_view.size(); ++view) {
    const std::size_t region = update.region_of_view[view];
    const std::size_t before = update.unknown.at(region).at(view);
    const std::size_t after = update.unknown.at(region).at(view + 1);
    table.rows.push_back(
        {std::to_string(view + 1), std::to_string(region + 1), std::to_string(before), std::to_string(after)});
    rows.push_back({{"view", view + 1}, {"region", region + 1}, {"unknown_before", before}, {"unknown_after", after}});
  }
  table.notes = {
      "The thesis shows pictures without figures. The rows of the picture here: the chosen view among its candidates, "
      "what the camera saw, and the map after the view with unknown space nearly black."};
  add_update_notes(options, update, table);
  table.figures = {{"rows", std::move(rows)}, {"thesis_views", thesis.views}};
  if (!options.draws) return table;
  const UpdatePictures& drawn = update.pictures;
  table.pictures.push_back({"fig-" + number.substr(0, 1) + "-" + number.substr(2) + ".png",
                            picture_rows({{"chosen view", drawn.choices}, {"seen", drawn.seen}, {"map", drawn.maps}})});
  return table;
}

}  // namespace saccade::reproduce
