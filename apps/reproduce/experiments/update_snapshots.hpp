// SPDX-License-Identifier: Apache-2.0
#pragma once
// update_snapshots: view after view of one update, for Figs. 2.17 and 2.18.

#include "experiments/updates.hpp"

namespace saccade::reproduce {

/// @param experiment  of kUpdateExperiments
/// @param number      of the figure, "2.17"
/// Errors of carry_out_updates.
[[nodiscard]] Result<ReproducedTable> update_snapshots(std::size_t experiment, const std::string& number,
                                                       const TableOptions& options, const Executor& executor,
                                                       const Progress& progress, std::optional<UpdateExperiments>& all);

}  // namespace saccade::reproduce
