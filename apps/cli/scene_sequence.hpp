// SPDX-License-Identifier: Apache-2.0
#pragma once
// saccade scene sequence.

#include "command.hpp"

namespace saccade::cli {

void add_scene_sequence(CLI::App& scene_command, const GlobalOptions& global, Action& action);

}  // namespace saccade::cli
