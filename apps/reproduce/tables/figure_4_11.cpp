// SPDX-License-Identifier: Apache-2.0
// Fig. 4.11: boundary precision and recall of supervoxels and LCCP on surfels.
#include "experiments/experiments.hpp"
#include "experiments/surfel_curves.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_4_11(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                    const Progress& progress) {
  return reproduce_curves(options, executor, progress, experiments.surfels, false);
}

}  // namespace saccade::reproduce
