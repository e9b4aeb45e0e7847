// SPDX-License-Identifier: Apache-2.0
#pragma once
// saccade scene scan.

#include <memory>

#include "command.hpp"

namespace saccade::cli {

[[nodiscard]] std::unique_ptr<Command> make_scene_scan();

}  // namespace saccade::cli
