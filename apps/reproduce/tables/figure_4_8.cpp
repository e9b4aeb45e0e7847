// SPDX-License-Identifier: Apache-2.0
// Fig. 4.8: surfels of magazines, in segments by flood fill, not enhanced beside enhanced.
#include "experiments/experiments.hpp"
#include "experiments/surfel_close_ups.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_4_8(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                   const Progress& progress) {
  const CloseUp close_up{
      "4.8", "fig-4-8.png", "two magazines and their headings", 4, true, {-0.05, -0.5, 0.8}, {0.01, -0.11, 0.0}, 0.48};
  return reproduce_segments(close_up, options, executor, progress, experiments.surfels);
}

}  // namespace saccade::reproduce
