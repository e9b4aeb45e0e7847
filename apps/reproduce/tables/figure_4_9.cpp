// SPDX-License-Identifier: Apache-2.0
// Fig. 4.9: surfels of a panel before a wall, from the side, with and without enhanced depth, not enhanced beside
// enhanced.
#include "experiments/experiments.hpp"
#include "experiments/surfel_close_ups.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_4_9(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                   const Progress& progress) {
  const CloseUp close_up{"4.9",
                         "fig-4-9.png",
                         "tools before a panel of 3 cm before a wall, from the side",
                         0,
                         true,
                         {-1.38, -0.36, 0.52},
                         {-0.9, 0.0, 0.43},
                         0.36};
  return reproduce_positions(close_up, options, executor, progress, experiments.surfels);
}

}  // namespace saccade::reproduce
