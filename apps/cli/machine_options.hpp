// SPDX-License-Identifier: Apache-2.0
#pragma once
// MachineOptions: which part of a campaign a command works on, and on which machines.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace saccade::cli {

/// Part of a campaign: slice `index` of `count`, from 0.
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

/// One of these at most is asked for; none: all runs, on this machine.
struct MachineOptions {
  bool list{false};
  std::optional<Slice> slice;  ///< run this part alone, into a shard of its own
  bool status{false};
  bool merge{false};
  std::vector<std::filesystem::path> merged;  ///< folders with shards; empty: those of the campaign
  bool slurm{false};
  bool set_aside{false};  ///< with merge and slurm: damaged shards make way
  SlurmOptions job;
};

/// Adds --list, --shard, --status, --merge, --slurm, and what goes with them.
void add_machine_options(CLI::App& command, MachineOptions& options);
/// Throws a usage error for what makes no sense, alone or together.
void check_machine_options(const MachineOptions& options);

}  // namespace saccade::cli
