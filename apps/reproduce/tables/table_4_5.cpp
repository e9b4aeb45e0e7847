// SPDX-License-Identifier: Apache-2.0
// Table 4.5: errors of annotation by control points and by rectangles, with simulated annotators in the place of
// people.
#include "experiments/experiments.hpp"
#include "tables.hpp"
#include "thesis/annotation_figures.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> table_4_5(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                  const Progress& progress) {
  return user_study(thesis::kTable4_5, "4.5", options, executor, progress, experiments.annotations);
}

}  // namespace saccade::reproduce
