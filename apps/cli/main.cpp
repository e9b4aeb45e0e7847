// SPDX-License-Identifier: Apache-2.0
// saccade: the command line with the planners of the library.
#include "command_line.hpp"
#include "saccade/trial/simulated_run.hpp"

int main(int argc, char** argv) { return saccade::cli::run_command_line(argc, argv, saccade::trial_planners()); }
