// SPDX-License-Identifier: Apache-2.0
#pragma once
// LoopMode: whether and when a command closes the loops of tracked poses.

#include "saccade/core/names.hpp"

namespace saccade::cli {

enum class LoopMode { off, end, online };
inline constexpr auto kLoopModeNames =
    make_names<LoopMode>({{LoopMode::off, "off"}, {LoopMode::end, "end"}, {LoopMode::online, "online"}});

}  // namespace saccade::cli
