// SPDX-License-Identifier: Apache-2.0
#pragma once
// run_missing: does what a campaign lacks of a comparison, several runs at once.

#include "comparison.hpp"
#include "progress_bar.hpp"

namespace saccade::cli {

/// Stores each run when it is done, until everything is done, one fails, or the user interrupts; what the others were
/// at then is lost. The figures are the same for every number of jobs and threads.
/// @param runs   runs of the plan, in its order
/// @param found  runs that are done; those that are done now are added
/// @return how many runs were done now; of several errors that of the run that comes first in the plan, naming its
/// scene.
[[nodiscard]] Result<std::size_t> run_missing(const Comparison& comparison, const std::vector<PlannedRun>& runs,
                                              CampaignIndex& found, const Campaign& campaign, std::size_t threads,
                                              ProgressBar& progress);

}  // namespace saccade::cli
