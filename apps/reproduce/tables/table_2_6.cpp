// SPDX-License-Identifier: Apache-2.0
// Table 2.6: saliencies and thresholds of the Gaussians of one pick-and-place task.
#include "experiments/hand_example.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> table_2_6(const TableOptions& options, Experiments& /*experiments*/,
                                  const Executor& /*executor*/, const Progress& progress) {
  return saliency_table(
      {"Table 2.6: saliency of the Gaussians of one pick-and-place task", HandTasks::pick_and_place, thesis::kTable2_6},
      options, progress);
}

}  // namespace saccade::reproduce
