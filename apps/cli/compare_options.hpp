// SPDX-License-Identifier: Apache-2.0
#pragma once
// CompareOptions: what `saccade compare` is told.

#include <filesystem>
#include <string>
#include <vector>

#include "command.hpp"
#include "run_options.hpp"

namespace saccade::cli {

struct CompareOptions {
  std::vector<std::string> scenes;  ///< as find_scene takes them, each once
  std::vector<StrategyKind> strategies;
  std::vector<std::uint64_t> seeds;  ///< ascending
  std::filesystem::path out;
  RunOptions run;
  /// The other strategies get as many views as sphere took with the same scene and seed, if sphere is compared.
  bool equal_views{true};
  bool list{false};
  bool force{false};

  // As they were given.
  std::string scene_list;
  std::string strategy_list{"sphere,random"};
  std::string seed_list{"1-10"};
};

void add_compare_options(CLI::App& command, CompareOptions& options);
/// After parsing: fills what was given as lists, and throws a usage error for what makes no sense.
void check_compare_options(CompareOptions& options);

/// "1-10,15": seeds and ranges of them, sorted, each once. Throws a usage error of --seeds.
[[nodiscard]] std::vector<std::uint64_t> parse_seeds(const std::string& text);

}  // namespace saccade::cli
