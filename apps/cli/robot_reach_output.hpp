// SPDX-License-Identifier: Apache-2.0
#pragma once
// What saccade robot reach leaves behind: summary, table, JSON and picture.

#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

#include "robot_reach.hpp"
#include "run_folder.hpp"

namespace saccade::cli {

constexpr std::array<std::string_view, 3> kReachFiles{"reach.json", "reach.csv", "reach.png"};

[[nodiscard]] nlohmann::json reach_json(const ReachTask& task, const ReachMap& map);
/// To standard output.
void print_reach(const ReachTask& task, const ReachMap& map, double test_ms);
/// reach.csv, reach.png, and `document` as reach.json, last.
[[nodiscard]] Status write_reach(const RunFolder& out, const ReachTask& task, const ReachMap& map,
                                 const nlohmann::json& document);

}  // namespace saccade::cli
