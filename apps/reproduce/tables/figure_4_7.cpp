// SPDX-License-Identifier: Apache-2.0
// Fig. 4.7: surfels of magazines, in segments by supervoxels and LCCP, not enhanced beside enhanced.
#include "experiments/experiments.hpp"
#include "experiments/surfel_close_ups.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_4_7(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                   const Progress& progress) {
  const CloseUp close_up{
      "4.7", "fig-4-7.png", "magazines, by the other algorithm", 3, false, {-0.05, -0.55, 0.75}, {0.0, 0.0, 0.0}, 0.55};
  return reproduce_segments(close_up, options, executor, progress, experiments.surfels);
}

}  // namespace saccade::reproduce
