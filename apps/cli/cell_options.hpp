// SPDX-License-Identifier: Apache-2.0
#pragma once
// Settings that a cell's file gives in place of options, and the programs of a cell as they are started.

#include "explore_options.hpp"
#include "saccade/arm/arm_model.hpp"
#include "saccade/devices/programs.hpp"
#include "saccade/tracking/reconstruction.hpp"

namespace saccade::cli {

/// After parsing: options that were not given take what the cell's file says, if the scene is a file. What is wrong
/// with the file is kept in cell_problem, to be said when the command runs.
void take_cell(ExploreOptions& options);

/// How a command's program is started: in the cell's folder and with its time limit where the cell names it. It gives
/// up soon after Ctrl-C.
[[nodiscard]] ProgramConfig program_config(const ExploreOptions& options, const std::string& command,
                                           const CellProgram& of_cell);
/// The joints of the arm behind joints_command.
[[nodiscard]] ProgramJointsConfig joints_config(const ExploreOptions& options, const ArmModel& arm);

}  // namespace saccade::cli
