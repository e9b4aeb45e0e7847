// SPDX-License-Identifier: Apache-2.0
// Table 2.8: seconds of the phases of updates.
#include "experiments/experiments.hpp"
#include "tables.hpp"
#include "text.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> table_2_8(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                  const Progress& progress) {
  SACCADE_CHECK(carry_out_updates(options, executor, progress, experiments.updates));
  const UpdateExperiments& all = *experiments.updates;
  ReproducedTable table;
  table.caption =
      "Table 2.8: seconds of the most relevant phases, mean of each experiment; thesis / " + here_name(options);
  table.columns = {"phase"};
  for (const ThesisExperiment& thesis : kUpdateExperiments) {
    table.columns.push_back(std::string{thesis.scene} + ", " + thesis_name(thesis.fuse_when));
  }
  const auto add = [&](const char* phase, double ThesisExperiment::*thesis, double OurUpdate::*here, int digits) {
    std::vector<std::string> row{phase};
    for (std::size_t i = 0; i < all.size(); ++i) {
      row.push_back(fixed(kUpdateExperiments.at(i).*thesis, 2) + " / " + fixed(all[i].*here, digits));
    }
    table.rows.push_back(std::move(row));
  };
  add("clear S(POI)", &ThesisExperiment::clear_s, &OurUpdate::clear_s, 5);
  add("next best view", &ThesisExperiment::nbv_s, &OurUpdate::nbv_s, 4);
  add("robot movement", &ThesisExperiment::movement_s, &OurUpdate::movement_s, 2);
  table.notes = {
      "Next best view: here candidates, reachability and gains of one choice, of " + fixed(all.front().evaluated, 0) +
          " poses in the first experiment. How long each ray of every pose takes, also for others, is Table 2.9.",
      "Robot movement: here the mean of the ways to the views, their oscillation included, and of the way back. In "
      "motion the arm has a quarter of its speed."};
  add_update_notes(options, all.front(), table);
  table.figures = updates_json(all, options.as_printed);
  return table;
}

}  // namespace saccade::reproduce
