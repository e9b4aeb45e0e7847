// SPDX-License-Identifier: Apache-2.0
// Fig. 2.17: view after view of experiment 1, frames fused at viewpoints (KFOVP).
#include "experiments/experiments.hpp"
#include "experiments/update_snapshots.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_2_17(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                    const Progress& progress) {
  return update_snapshots(0, "2.17", options, executor, progress, experiments.updates);
}

}  // namespace saccade::reproduce
