// SPDX-License-Identifier: Apache-2.0
// Fig. 2.21: the map of thesis §2.4.4 and the region of interest on it.
#include "experiments/experiments.hpp"
#include "saccade/report/exploration_pictures.hpp"
#include "saccade/report/sheet.hpp"
#include "tables.hpp"
#include "text.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_2_21(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                    const Progress& progress) {
  SACCADE_CHECK(carry_out_update_task(options, executor, progress, experiments.update_task));
  const thesis::UpdateTask& task = *experiments.update_task;
  const TsdfGrid::Usage usage = task.map.grid.usage();
  const std::size_t unknown = count_unknown(task.map, task.region);
  ReproducedTable table;
  table.caption = "Fig. 2.21: the map that Tables 2.9 and 2.10 are made on, and its region of interest";
  table.columns = {"scene", "frames", "bricks of 8³ voxels", "voxel", "unknown voxels in the region"};
  table.rows = {{task.scene, std::to_string(task.frames), std::to_string(usage.bricks()),
                 millimetres(task.map.config.voxel_size_m), std::to_string(unknown)}};
  table.notes = {
      "The thesis shows pictures of a real table without figures; here the scene is simulated, and the region, on top "
      "of "
      "a box, was set back to unknown."};
  table.figures = {{"rows",
                    {{{"scene", task.scene},
                      {"frames", task.frames},
                      {"bricks", usage.bricks()},
                      {"voxel_size_m", task.map.config.voxel_size_m},
                      {"unknown", unknown}}}}};
  if (!options.draws) return table;
  const Viewpoint view = overview_of(task.map.config.workspace.value(), {.width = 560, .height = 420});
  TernaryPictureConfig ternary;
  TernaryPictureConfig region;
  region.unknown_within = {task.region};
  table.pictures.push_back(
      {"fig-2-21.png",
       compose({"The map of §2.4.4 (thesis Fig. 2.21)",
                {{ternary_picture(task.map, view, executor, ternary), "unknown nearly black", {}, {}, {}},
                 {ternary_picture(task.map, view, executor, region), "unknown in the region alone", {}, {}, {}}},
                ""})});
  return table;
}

}  // namespace saccade::reproduce
