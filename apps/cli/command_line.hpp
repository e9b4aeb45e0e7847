// SPDX-License-Identifier: Apache-2.0
#pragma once
// run_command_line: the whole program. A program of one's own adds its planners and calls it
// (examples/own_strategy.cpp).

#include "saccade/explore/planners.hpp"

namespace saccade::cli {

/// Runs the command that the arguments name and prints its result.
/// @param planners  strategies that explore and compare know: trial_planners(), and one's own
/// @return the exit status
[[nodiscard]] int run_command_line(int argc, char** argv, Planners planners);

}  // namespace saccade::cli
