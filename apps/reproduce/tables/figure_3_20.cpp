// SPDX-License-Identifier: Apache-2.0
// Fig. 3.20: view after view of experiment 3 by object-driven attention.
#include "experiments/experiments.hpp"
#include "experiments/exploration_snapshots.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_3_20(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                    const Progress& progress) {
  return exploration_snapshots(experiments.explorations.attention, 2, "3.20", options, executor, progress);
}

}  // namespace saccade::reproduce
