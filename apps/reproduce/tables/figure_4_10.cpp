// SPDX-License-Identifier: Apache-2.0
// Fig. 4.10: boundary precision and recall of flood fill on surfels.
#include "experiments/experiments.hpp"
#include "experiments/surfel_curves.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_4_10(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                    const Progress& progress) {
  return reproduce_curves(options, executor, progress, experiments.surfels, true);
}

}  // namespace saccade::reproduce
