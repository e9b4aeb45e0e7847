// SPDX-License-Identifier: Apache-2.0
// Fig. 4.5: surfels of small tools of the first workshop, not enhanced beside enhanced.
#include "experiments/experiments.hpp"
#include "experiments/surfel_close_ups.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_4_5(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                   const Progress& progress) {
  const CloseUp close_up{"4.5", "fig-4-5.png",       "small tools on a panel", 0,
                         true,  {0.28, -0.95, 0.36}, {0.37, 0.0, 0.31},        0.62};
  return reproduce_segments(close_up, options, executor, progress, experiments.surfels);
}

}  // namespace saccade::reproduce
