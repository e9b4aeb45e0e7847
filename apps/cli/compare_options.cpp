// SPDX-License-Identifier: Apache-2.0
#include "compare_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <limits>
#include <optional>
#include <set>

#include "add_value.hpp"
#include "saccade/scene/scene_yaml.hpp"

namespace saccade::cli {
namespace {

std::optional<std::uint64_t> seed_of(std::string_view text) {
  // The campaign file keeps seeds as signed numbers.
  constexpr auto kLargest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  const std::optional<std::uint64_t> seed = whole_number(text);
  return seed && *seed <= kLargest ? seed : std::nullopt;
}

constexpr std::uint64_t kMostInRange{100000};
constexpr std::string_view kClutter{"clutter:"};
constexpr auto kNoiseNames = make_names<std::optional<DepthSensor>>(
    {{std::nullopt, "none"}, {DepthSensor::kinect_v1, "kinect-v1"}, {DepthSensor::kinect_v2, "kinect-v2"}});

/// "3" and "1-10"; nullopt for anything else.
std::optional<std::pair<std::uint64_t, std::uint64_t>> seed_range(std::string_view text) {
  const std::size_t dash = text.find('-');
  const auto first = seed_of(text.substr(0, dash));
  const auto last = dash == std::string_view::npos ? first : seed_of(text.substr(dash + 1));
  if (!first || !last || *first > *last) return std::nullopt;
  return std::pair{*first, *last};
}

void add_once(std::vector<std::string>& names, std::string name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
}

std::vector<std::string> scenes_of(const std::string& text) {
  std::vector<std::string> names;
  for (const std::string& part : list_parts("--scenes", text)) {
    if (part == "all") {
      for (const BuiltinScene& builtin : builtin_scenes()) add_once(names, std::string{builtin.name});
    } else if (part.starts_with(kClutter) && part.find('-') != std::string::npos) {
      const auto range = seed_range(std::string_view{part}.substr(kClutter.size()));
      if (!range || range->second - range->first >= kMostInRange) {
        usage_error("--scenes", "clutter:1-30 is a range of at most " + std::to_string(kMostInRange) +
                                    " seeds, the smaller first, not '" + part + "'");
      }
      for (std::uint64_t seed = range->first; seed <= range->second; ++seed) {
        add_once(names, std::string{kClutter} + std::to_string(seed));
      }
    } else {
      add_once(names, part);
    }
  }
  return names;
}

/// The strategies; sphere first where it gives the others their number of views.
std::vector<NamedPlanner> strategies_of(const CompareOptions& options, const Planners& planners) {
  std::vector<NamedPlanner> strategies = parse_strategies(options.strategy_list, planners);
  if (!options.equal_views) return strategies;
  const auto sphere = std::find_if(strategies.begin(), strategies.end(),
                                   [](const NamedPlanner& strategy) { return strategy.name == kEqualViewsOf; });
  if (sphere == strategies.end()) usage_error("--equal-views", "needs sphere among the strategies");
  std::rotate(strategies.begin(), sphere, sphere + 1);  // the others have to know how many views it took
  return strategies;
}

std::vector<std::string> noises_of(const CompareOptions& options) {
  if (options.noise_list.empty()) return {noise_key(options.run.run)};
  std::vector<std::string> noises = list_parts("--noise", options.noise_list);
  for (const std::string& noise : noises) {
    if (!kNoiseNames.find(noise)) usage_error("--noise", unknown_word(noise, kNoiseNames.words));
  }
  return noises;
}

/// "1-10,15": seeds and ranges of them, sorted, each once. Throws a usage error of --seeds.
std::vector<std::uint64_t> parse_seeds(const std::string& text) {
  std::set<std::uint64_t> seeds;
  for (const std::string& part : list_parts("--seeds", text)) {
    const auto range = seed_range(part);
    if (!range) {
      usage_error("--seeds", "needs whole numbers and ranges of them below 2^63, such as 1-10,15, not '" + text + "'");
    }
    const std::uint64_t more = range->second - range->first;
    if (more >= kMostInRange || seeds.size() + more >= kMostInRange) {
      usage_error("--seeds", "at most " + std::to_string(kMostInRange) + " seeds");
    }
    for (std::uint64_t seed = range->first; seed <= range->second; ++seed) seeds.insert(seed);
  }
  return {seeds.begin(), seeds.end()};
}

/// The --seed of the program that a command belongs to; null where there is none.
const CLI::Option* program_seed_of(const CLI::App& command) {
  const CLI::App* program = &command;
  while (program->get_parent() != nullptr) program = program->get_parent();
  return program->get_option_no_throw("--seed");
}

}  // namespace

std::vector<std::string> list_parts(const std::string& option, const std::string& text) {
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

std::vector<NamedPlanner> parse_strategies(const std::string& text, const Planners& planners) {
  std::vector<NamedPlanner> strategies;
  for (const std::string& name : list_parts("--strategies", text)) {
    const auto strategy = planners.find(name);
    if (!strategy) usage_error("--strategies", strategy.error().message);
    strategies.push_back(*strategy);
  }
  return strategies;
}

std::string noise_key(const SimulatedRunConfig& run) {
  return std::string{kNoiseNames.of(run.noise ? std::optional{run.sensor} : std::nullopt)};
}

void set_noise(SimulatedRunConfig& run, const std::string& name) {
  const std::optional<DepthSensor> sensor = kNoiseNames.find(name).value();
  run.noise = sensor.has_value();
  run.sensor = sensor.value_or(run.sensor);
}

void add_campaign_options(CLI::App& command, CompareOptions& options) {
  add_value(command, "--seeds", options.seed_list, "LIST", "seeds of noise and chance, each makes one run: 1-10,15");
  add_value(command, "--jobs", options.jobs, "N",
            "runs at once; they share --threads, and the figures do not depend on it (default: one per thread)")
      ->check(CLI::Range(1, 256));
  add_machine_options(command, options.machines);
  options.program_seed = program_seed_of(command);
}

void check_campaign_options(CompareOptions& options) {
  if (options.program_seed != nullptr && options.program_seed->count() > 0) {
    usage_error("--seed", "the runs of a campaign have the seeds of --seeds, such as --seeds " +
                              options.program_seed->results().front());
  }
  options.seeds = parse_seeds(options.seed_list);
  check_machine_options(options.machines);
}

void add_compare_options(CLI::App& command, CompareOptions& options, const Planners& planners) {
  add_value(command, "--scenes", options.scene_list, "LIST",
            "scenes, separated by commas: built-in ones or all of them (all), clutter:SEED, clutter:1-30, YAML files, "
            "mesh files, and folders of meshes, each of which is put on a table")
      ->required();
  add_value(command, "--strategies", options.strategy_list, "LIST",
            "strategies, separated by commas: " + planners.names());
  add_run_options(command, options.run, min_gain_by_strategy());
  add_foresight_options(command, options.run);
  add_value(command, "--noise", options.noise_list, "LIST",
            "noise of the depth, separated by commas: none, kinect-v1, kinect-v2 (default: that of --sensor)")
      ->excludes("--sensor")
      ->excludes("--no-noise");
  add_value(command, "--robot", options.robot, "ROBOT",
            "carrier of the camera: free, which flies, comau, or a URDF file");
  add_reading_options(command, options.arm_reading);
  add_mesh_options(command, options.mesh);
  command.add_flag("--equal-views", options.equal_views,
                   "give every other strategy as many views as sphere took, instead of --max-views");
  add_campaign_options(command, options);
}

void check_compare_options(CompareOptions& options, const Planners& planners) {
  options.scenes = scenes_of(options.scene_list);
  options.strategies = strategies_of(options, planners);
  check_campaign_options(options);
  require_ok(options.mesh.validate(), "--mesh-scale");
  check_run_options(options.run);
  options.noises = noises_of(options);  // after the camera, whose noise is the default
  check_foresight(options.run, options.robot);
  check_arm_options(options.arm_reading);
  if (options.robot == "free") require_no_reading(options.arm_reading);
}

}  // namespace saccade::cli
