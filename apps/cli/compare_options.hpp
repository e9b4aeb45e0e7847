// SPDX-License-Identifier: Apache-2.0
#pragma once
// CompareOptions: what a campaign is told, by `saccade compare` or by a command that makes one of its own.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "command.hpp"
#include "machine_options.hpp"
#include "robot_options.hpp"
#include "run_options.hpp"
#include "saccade/scene/scene_yaml.hpp"

namespace saccade::cli {

/// The strategy that gives --equal-views their number.
constexpr std::string_view kEqualViewsOf{"sphere"};

struct CompareOptions {
  std::vector<std::string> scenes;  ///< as they were given, each once; ranges of clutter and "all" taken apart
  std::vector<NamedPlanner> strategies;
  std::vector<std::string> noises;   ///< names, each once
  std::vector<std::uint64_t> seeds;  ///< ascending
  std::filesystem::path out;
  RunOptions run;
  ArmOptions arm_reading;     ///< its robot is not used
  std::string robot{"free"};  ///< a built-in arm, a URDF, or free
  MeshSceneConfig mesh;       ///< how mesh files become scenes
  std::size_t jobs{0};        ///< runs at once; 0: as many as threads
  /// The other strategies get as many views as sphere took with the same scene, noise and seed.
  bool equal_views{false};
  /// Runs that no seed changes have the first seed alone (Comparison::is_same_for_all_seeds).
  bool same_runs_once{false};
  MachineOptions machines;
  const CLI::Option* program_seed{nullptr};  ///< --seed of the program, which is not for campaigns; null: there is none

  // As they were given.
  std::string scene_list;
  std::string strategy_list{"surface,attention,standard"};
  std::string noise_list;
  std::string seed_list{"1-10"};
};

/// Adds the options of `saccade compare`, those of every campaign included.
void add_compare_options(CLI::App& command, CompareOptions& options, const Planners& planners);
/// After parsing: fills what was given as lists, and throws a usage error for what makes no sense.
void check_compare_options(CompareOptions& options, const Planners& planners);

/// "a,b": the parts between commas, each once. Throws a usage error of the option where one of them is empty.
[[nodiscard]] std::vector<std::string> list_parts(const std::string& option, const std::string& text);

/// "surface,random": planners by their names, each once. Throws a usage error of --strategies.
[[nodiscard]] std::vector<NamedPlanner> parse_strategies(const std::string& text, const Planners& planners);

/// Adds the options of every campaign: seeds, runs at once, several machines.
void add_campaign_options(CLI::App& command, CompareOptions& options);
/// After parsing: fills what they gave as lists, and throws a usage error for what makes no sense.
void check_campaign_options(CompareOptions& options);

/// "none", or the name of the sensor whose noise it is.
[[nodiscard]] std::string noise_key(const SimulatedRunConfig& run);
/// The inverse. Expects such a name.
void set_noise(SimulatedRunConfig& run, const std::string& name);

}  // namespace saccade::cli
