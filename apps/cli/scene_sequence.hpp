// SPDX-License-Identifier: Apache-2.0
#pragma once
// saccade scene sequence.

#include <memory>

#include "command.hpp"

namespace saccade::cli {

[[nodiscard]] std::unique_ptr<Command> make_scene_sequence();

}  // namespace saccade::cli
