// SPDX-License-Identifier: Apache-2.0
// Fig. 2.14: the trajectory of one pick-and-place task and the Gaussians fitted to it.
#include "experiments/hand_example.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_2_14(const TableOptions& options, Experiments& /*experiments*/,
                                    const Executor& /*executor*/, const Progress& progress) {
  return mixture_figure({"Fig. 2.14: Gaussians of the trajectory of one pick-and-place task", HandTasks::pick_and_place,
                         thesis::kTable2_6},
                        "fig-2-14.png", options, progress);
}

}  // namespace saccade::reproduce
