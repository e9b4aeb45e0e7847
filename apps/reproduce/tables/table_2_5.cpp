// SPDX-License-Identifier: Apache-2.0
// Table 2.5: saliencies and thresholds of the Gaussians of one placement.
#include "experiments/hand_example.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> table_2_5(const TableOptions& options, Experiments& /*experiments*/,
                                  const Executor& /*executor*/, const Progress& progress) {
  return saliency_table({"Table 2.5: saliency of the Gaussians of one placement or removal",
                         HandTasks::placements_and_removals, thesis::kTable2_5},
                        options, progress);
}

}  // namespace saccade::reproduce
