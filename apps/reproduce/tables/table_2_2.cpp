// SPDX-License-Identifier: Apache-2.0
// Table 2.2: GMM-AS and the ZVC-like detector on the recorded hands.
#include "experiments/hand_rates.hpp"
#include "tables.hpp"
#include "text.hpp"

namespace saccade::reproduce {
namespace {

HandRatesRow as_printed(HandRatesRow row) {
  row.algorithm.as_printed = true;
  return row;
}

void add_tasks(std::vector<HandRatesRow>& rows, const char* name, const char* figure, HandTasks tasks,
               const thesis::TaskRates& thesis) {
  HandRatesRow row;
  row.condition = name;
  row.conditions = {{"tasks", figure}};
  row.tasks = tasks;
  const std::size_t first = rows.size();
  add_rows(rows, std::move(row), thesis.zvc, thesis.gmm);
  rows.push_back(as_printed(rows[first]));
  rows.push_back(as_printed(rows[first + 1]));
}

}  // namespace

Result<ReproducedTable> table_2_2(const TableOptions& options, Experiments& /*experiments*/, const Executor& executor,
                                  const Progress& progress) {
  HandRatesSpec spec;
  spec.caption = "Table 2.2: detectors of hand actions: precision / recall, %";
  spec.condition = "tasks";
  add_tasks(spec.rows, "placements and removals", "placements_removals", HandTasks::placements_and_removals,
            thesis::kTable2_2PlacementsAndRemovals);
  add_tasks(spec.rows, "pick-and-place", "pick_and_place", HandTasks::pick_and_place, thesis::kTable2_2PickAndPlace);
  spec.notes = {
      "As printed: eq. 2.13 and POITh = 2.5; ZVCTh = 1.72, and nothing about ends. A saliency with a unit is hardly "
      "ever "
      "2.5 times that of the neighbours."};
  return hand_rates_table(std::move(spec), options, executor, progress);
}

}  // namespace saccade::reproduce
