// SPDX-License-Identifier: Apache-2.0
// Fig. 4.6: surfels of the second workshop, not enhanced beside enhanced.
#include "experiments/experiments.hpp"
#include "experiments/surfel_close_ups.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_4_6(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                   const Progress& progress) {
  const CloseUp close_up{
      "4.6", "fig-4-6.png", "single surfels along borders", 1, true, {-0.45, -0.9, 0.75}, {-0.43, 0.0, 0.71}, 0.4};
  return reproduce_segments(close_up, options, executor, progress, experiments.surfels);
}

}  // namespace saccade::reproduce
