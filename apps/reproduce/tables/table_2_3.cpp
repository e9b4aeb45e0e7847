// SPDX-License-Identifier: Apache-2.0
// Table 2.3: the detectors of hand actions at other speeds.
#include "experiments/hand_rates.hpp"
#include "tables.hpp"
#include "text.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> table_2_3(const TableOptions& options, Experiments& /*experiments*/, const Executor& executor,
                                  const Progress& progress) {
  HandRatesSpec spec;
  spec.caption = "Table 2.3: detectors of hand actions at other speeds: precision / recall, %";
  spec.condition = "speed";
  for (const thesis::ConditionRates& thesis : thesis::kTable2_3) {
    HandRatesRow row;
    row.condition = fixed(thesis.speed, 2);
    row.conditions = {{"speed", thesis.speed}};
    row.speed = thesis.speed;
    add_rows(spec.rows, std::move(row), thesis.zvc, thesis.gmm);
  }
  spec.notes = {
      "Speed is the number of samples over the recorded one, resampled linearly: 0.25 gives a quarter of them."};
  return hand_rates_table(std::move(spec), options, executor, progress);
}

}  // namespace saccade::reproduce
