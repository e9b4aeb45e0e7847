// SPDX-License-Identifier: Apache-2.0
#pragma once
// CompareOptions: what `saccade compare` is told.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "command.hpp"
#include "robot_options.hpp"
#include "run_options.hpp"
#include "saccade/scene/scene_yaml.hpp"

namespace saccade::cli {

/// The strategy that gives --equal-views their number.
constexpr std::string_view kEqualViewsOf{"sphere"};

/// Part of a comparison: slice `index` of `count`, from 0.
struct Slice {
  std::size_t index{0};
  std::size_t count{1};

  [[nodiscard]] bool operator==(const Slice&) const = default;
};

/// Job array of Slurm, as it is asked for.
struct SlurmOptions {
  std::string partition;  ///< empty: the cluster's default
  std::string time;       ///< limit of a task, as sbatch reads it; empty: the partition's
  std::size_t cpus{1};    ///< each task has
  std::size_t tasks{0};   ///< slices; 0: one per run, at most kMostTasks
  bool dry_run{false};
};
constexpr std::size_t kMostTasks{100};

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
  bool list{false};
  std::optional<Slice> slice;  ///< run this part alone, into a shard of its own
  bool status{false};
  bool merge{false};
  std::vector<std::filesystem::path> merged;  ///< folders with shards; empty: those of the campaign
  bool slurm{false};
  SlurmOptions job;

  // As they were given.
  std::string scene_list;
  std::string strategy_list{"surface,attention,standard"};
  std::string noise_list;
  std::string seed_list{"1-10"};
  std::string slice_text;
};

void add_compare_options(CLI::App& command, CompareOptions& options, const Planners& planners);
/// After parsing: fills what was given as lists, and throws a usage error for what makes no sense.
void check_compare_options(CompareOptions& options, const Planners& planners);

/// "surface,random": planners by their names, each once. Throws a usage error of --strategies.
[[nodiscard]] std::vector<NamedPlanner> parse_strategies(const std::string& text, const Planners& planners);

/// "1-10,15": seeds and ranges of them, sorted, each once. Throws a usage error of --seeds.
[[nodiscard]] std::vector<std::uint64_t> parse_seeds(const std::string& text);

/// "2/10": slice 2 of 0 … 9. "auto/10" takes the number from the environment of a job array, of mpirun or of
/// Kubernetes. Throws a usage error of --shard.
[[nodiscard]] Slice parse_slice(const std::string& text);

/// "none", or the name of the sensor whose noise it is.
[[nodiscard]] std::string noise_key(const SimulatedRunConfig& run);
/// The inverse. Expects such a name.
void set_noise(SimulatedRunConfig& run, const std::string& name);

}  // namespace saccade::cli
