// SPDX-License-Identifier: Apache-2.0
// Fig. 2.13: the trajectory of one placement or removal and the Gaussians fitted to it.
#include "experiments/hand_example.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_2_13(const TableOptions& options, Experiments& /*experiments*/,
                                    const Executor& /*executor*/, const Progress& progress) {
  return mixture_figure({"Fig. 2.13: Gaussians of the trajectory of one placement or removal",
                         HandTasks::placements_and_removals, thesis::kTable2_5},
                        "fig-2-13.png", options, progress);
}

}  // namespace saccade::reproduce
