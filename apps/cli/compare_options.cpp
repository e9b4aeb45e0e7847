// SPDX-License-Identifier: Apache-2.0
#include "compare_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <set>

#include "saccade/io/scene_yaml.hpp"

namespace saccade::cli {
namespace {

/// The parts between commas. Throws a usage error when one of them is empty.
std::vector<std::string> parts_of(const std::string& option, const std::string& text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    if (end == begin) usage_error(option, "needs a list without gaps, such as a,b, not '" + text + "'");
    std::string part = text.substr(begin, end - begin);
    if (std::find(parts.begin(), parts.end(), part) == parts.end()) parts.push_back(std::move(part));
    if (end == text.size()) return parts;
    begin = end + 1;
  }
}

std::optional<std::uint64_t> seed_of(std::string_view text) {
  std::uint64_t seed = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), seed);
  // The campaign file keeps seeds as signed numbers.
  constexpr auto kLargest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (code != std::errc{} || end != text.data() + text.size() || seed > kLargest) return std::nullopt;
  return seed;
}

std::vector<std::string> scenes_of(const std::string& text) {
  if (text != "all") return parts_of("--scenes", text);
  std::vector<std::string> names;
  for (const BuiltinScene& builtin : builtin_scenes()) names.emplace_back(builtin.name);
  return names;
}

/// Sphere first: the others may have to know how many views it took.
std::vector<StrategyKind> strategies_of(const std::string& text) {
  std::vector<StrategyKind> strategies;
  for (const std::string& name : parts_of("--strategies", text)) {
    const auto strategy = strategy_kind(name);
    if (!strategy) usage_error("--strategies", strategy.error().message);
    strategies.push_back(*strategy);
  }
  std::stable_partition(strategies.begin(), strategies.end(),
                        [](StrategyKind strategy) { return strategy == StrategyKind::sphere; });
  return strategies;
}

}  // namespace

std::vector<std::uint64_t> parse_seeds(const std::string& text) {
  constexpr std::uint64_t kMost{100000};
  std::set<std::uint64_t> seeds;
  for (const std::string& part : parts_of("--seeds", text)) {
    const std::size_t dash = part.find('-');
    const auto first = seed_of(std::string_view{part}.substr(0, dash));
    const auto last = dash == std::string::npos ? first : seed_of(std::string_view{part}.substr(dash + 1));
    if (!first || !last || *first > *last) {
      usage_error("--seeds", "needs whole numbers and ranges of them below 2^63, such as 1-10,15, not '" + text + "'");
    }
    if (*last - *first >= kMost || seeds.size() + (*last - *first) >= kMost) {
      usage_error("--seeds", "at most " + std::to_string(kMost) + " seeds");
    }
    for (std::uint64_t seed = *first; seed <= *last; ++seed) seeds.insert(seed);
  }
  return {seeds.begin(), seeds.end()};
}

void add_compare_options(CLI::App& command, CompareOptions& options) {
  command
      .add_option("--scenes", options.scene_list,
                  "scenes, separated by commas: built-in ones, clutter:SEED, YAML files; all: every built-in one")
      ->required()
      ->type_name("LIST");
  command.add_option("--strategies", options.strategy_list, "strategies, separated by commas: " + strategy_names())
      ->type_name("LIST")
      ->capture_default_str();
  command.add_option("--seeds", options.seed_list, "seeds of noise and chance, each makes one run: 1-10,15")
      ->type_name("LIST")
      ->capture_default_str();
  command.add_option("--out", options.out, "folder for the results; runs that are in it already are not repeated")
      ->required()
      ->type_name("DIR");
  add_run_options(command, options.run, min_gain_by_strategy());
  command
      .add_flag("--equal-views,!--no-equal-views", options.equal_views,
                "every other strategy gets as many views as sphere took (default)")
      ->default_str("");
  command.add_flag("--list", options.list, "say what would be run, and run nothing");
  command.add_flag("--force", options.force, "write into a folder that holds other files");
}

void check_compare_options(CompareOptions& options) {
  options.scenes = scenes_of(options.scene_list);
  options.strategies = strategies_of(options.strategy_list);
  options.seeds = parse_seeds(options.seed_list);
  check_run_options(options.run);
}

}  // namespace saccade::cli
