// SPDX-License-Identifier: Apache-2.0
// Table 2.7: error, completeness, views and time of updates after a user's task.
#include "experiments/experiments.hpp"
#include "tables.hpp"
#include "text.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> table_2_7(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                  const Progress& progress) {
  SACCADE_CHECK(carry_out_updates(options, executor, progress, experiments.updates));
  const UpdateExperiments& all = *experiments.updates;
  ReproducedTable table;
  table.caption = "Table 2.7: error, completeness, views and time of updates; thesis / " + here_name(options);
  table.columns = {"experiment", "frames fused", "mean abs. error (m)", "completeness", "views", "time (s)"};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ThesisExperiment& thesis = kUpdateExperiments.at(i);
    const OurUpdate& update = all[i];
    table.rows.push_back({std::to_string(thesis.number) + ", " + thesis.scene, thesis_name(thesis.fuse_when),
                          fixed(thesis.error_m, 3) + " / " + fixed(update.mean_abs_error_m, 4),
                          std::to_string(thesis.completeness) + " of 10 / " + percent(update.coverage),
                          std::to_string(thesis.views) + " / " + std::to_string(update.views),
                          fixed(thesis.time_s, 0) + " / " + fixed(update.robot_s + update.computing_s, 1)});
  }
  table.notes = {
      "Errors are of the height and both axes of the object that was put down (docs/reference/metrics.md).",
      "Completeness: the thesis gave marks from 1 to 10 by eye; here it is the share of the surface that can be seen "
      "inside a region, table included, which the mesh has within a voxel, of the region that has least.",
      "Time: here what the simulated arm's motions take, and what was computed between them on this machine; the "
      "thesis' is that of its whole system.",
      "In the second experiment the thesis had three regions, two of them almost the same; here there are as many as "
      "the detector found: " +
          std::to_string(all.back().regions) + "."};
  add_update_notes(options, all.front(), table);
  table.figures = updates_json(all, options.as_printed);
  return table;
}

}  // namespace saccade::reproduce
