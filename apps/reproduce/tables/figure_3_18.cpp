// SPDX-License-Identifier: Apache-2.0
// Fig. 3.18: view after view of experiment 1 by object-driven attention.
#include "experiments/experiments.hpp"
#include "experiments/exploration_snapshots.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_3_18(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                    const Progress& progress) {
  return exploration_snapshots(experiments.explorations.attention, 0, "3.18", options, executor, progress);
}

}  // namespace saccade::reproduce
