// SPDX-License-Identifier: Apache-2.0
#pragma once
// exploration_snapshots: view after view of one exploration, for Figs. 3.18 to 3.21.

#include "experiments/explorations.hpp"

namespace saccade::reproduce {

/// @param all     runs of one strategy
/// @param scene   of kTabletops
/// @param number  of the figure, "3.18"
/// Errors of exploration.
[[nodiscard]] Result<ReproducedTable> exploration_snapshots(Explorations& all, std::size_t scene,
                                                            const std::string& number, const TableOptions& options,
                                                            const Executor& executor, const Progress& progress);

}  // namespace saccade::reproduce
