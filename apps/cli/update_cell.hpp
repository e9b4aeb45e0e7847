// SPDX-License-Identifier: Apache-2.0
#pragma once
// Updates of a real cell: a hand's tasks as they end, and after each the robot looks again at what it may have changed.

#include "update_options.hpp"

namespace saccade::cli {

/// Scans the cell, or begins with a saved map, and waits for tasks until the tracker ends or the user interrupts. Opens
/// the folder, and writes the map and update.json into it after each task. Errors: those of the cell's file, its
/// devices and its tracker; what was seen until then is kept.
[[nodiscard]] Result<Outcome> update_cell(const UpdateOptions& options, Context& context);

}  // namespace saccade::cli
