// SPDX-License-Identifier: Apache-2.0
#pragma once
// Updates of a real cell: a hand's tasks as they end, and after each the robot looks again at what it may have changed.

#include "update_options.hpp"

namespace saccade::cli {

/// Scans the cell, or begins with a saved map, and waits for tasks until the tracker ends or the user interrupts. The
/// map and update.json are written after each task. Returns the exit status.
[[nodiscard]] Result<int> run_cell_update(const UpdateOptions& options, const GlobalOptions& global);

}  // namespace saccade::cli
