// SPDX-License-Identifier: Apache-2.0
// Fig. 3.21: view after view of experiment 3 by the standard method.
#include "experiments/experiments.hpp"
#include "experiments/exploration_snapshots.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_3_21(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                    const Progress& progress) {
  return exploration_snapshots(experiments.explorations.standard, 2, "3.21", options, executor, progress);
}

}  // namespace saccade::reproduce
