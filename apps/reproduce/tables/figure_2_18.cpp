// SPDX-License-Identifier: Apache-2.0
// Fig. 2.18: view after view of experiment 2, frames fused at viewpoints (KFOVP).
#include "experiments/experiments.hpp"
#include "experiments/update_snapshots.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_2_18(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                    const Progress& progress) {
  return update_snapshots(2, "2.18", options, executor, progress, experiments.updates);
}

}  // namespace saccade::reproduce
