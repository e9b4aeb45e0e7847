// SPDX-License-Identifier: Apache-2.0
// Fig. 4.20: stray points of annotation by rectangles and by control points.
#include "experiments/experiments.hpp"
#include "experiments/misplaced_points.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_4_20(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                    const Progress& progress) {
  return misplaced_points(Misplaced::stray, "4.20", options, executor, progress, experiments.annotations);
}

}  // namespace saccade::reproduce
