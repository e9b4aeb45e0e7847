// SPDX-License-Identifier: Apache-2.0
// Fig. 3.19: view after view of experiment 1 by the standard method.
#include "experiments/experiments.hpp"
#include "experiments/exploration_snapshots.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_3_19(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                    const Progress& progress) {
  return exploration_snapshots(experiments.explorations.standard, 0, "3.19", options, executor, progress);
}

}  // namespace saccade::reproduce
