// SPDX-License-Identifier: Apache-2.0
#pragma once
// Output of `saccade robot reach`: summary, table, JSON and picture.

#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

#include "robot_reach.hpp"
#include "run_folder.hpp"

namespace saccade::cli {

constexpr std::array<std::string_view, 3> kReachFiles{"reach.json", "reach.csv", "reach.png"};

[[nodiscard]] nlohmann::json reach_json(const ReachTask& task, const ReachMap& map);
[[nodiscard]] std::string reach_text(const ReachTask& task, const ReachMap& map, double test_ms);
/// Writes reach.csv and, with pictures, reach.png.
[[nodiscard]] Status write_reach(const RunFolder& out, const ReachTask& task, const ReachMap& map, bool pictures);

}  // namespace saccade::cli
