// SPDX-License-Identifier: Apache-2.0
#pragma once
// reproduce_curves: boundary precision over recall, not enhanced and enhanced, for Figs. 4.10 and 4.11.

#include "experiments/surfel_trials.hpp"

namespace saccade::reproduce {

/// Errors of surfel_trials.
[[nodiscard]] Result<ReproducedTable> reproduce_curves(const TableOptions& options, const Executor& executor,
                                                       const Progress& progress, SurfelExperiments& all,
                                                       bool by_flood_fill);

}  // namespace saccade::reproduce
