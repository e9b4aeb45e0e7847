// SPDX-License-Identifier: Apache-2.0
#include "machine_options.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "add_value.hpp"
#include "options.hpp"
#include "saccade/core/names.hpp"

namespace saccade::cli {
namespace {

constexpr std::size_t kMostSlices{100000};

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

// The number of a task of an array, and ranks of a job's processes; all from 0.
constexpr const char* kArrayNumber{"SLURM_ARRAY_TASK_ID"};
constexpr std::array kRanks{"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"};
constexpr const char* kIndexOfKubernetes{"JOB_COMPLETION_INDEX"};
constexpr const char* kRankOfSlurm{"SLURM_PROCID"};

/// SLURM_PROCID, where the job has as many tasks as there are slices; else empty. A job of one task has it too.
std::string rank_of_slurm(const std::string& slices) {
  const std::string of_step = environment("SLURM_STEP_NUM_TASKS");
  const std::string tasks = of_step.empty() ? environment("SLURM_NTASKS") : of_step;
  return tasks == slices ? environment(kRankOfSlurm) : "";
}

/// The number of this task among all that run slices. Throws a usage error of --shard.
std::string number_of_task(const std::string& slices) {
  const std::string array = environment(kArrayNumber);
  if (!array.empty()) {
    // A job of an array has ranks as well where it starts an MPI; they would all take one slice.
    for (const char* name : {kRanks[0], kRanks[1], kRanks[2], kRankOfSlurm}) {
      const std::string rank = environment(name);
      if (rank.empty() || rank == "0") continue;
      usage_error("--shard", std::string{"cannot tell the slice: "} + kArrayNumber + " is " + array + " and " + name +
                                 " is " + rank + "; name the slice, such as 0/10, or run one process per task");
    }
    return array;
  }
  for (const char* name : {kRanks[0], kRanks[1], kRanks[2], kIndexOfKubernetes}) {
    if (const std::string number = environment(name); !number.empty()) return number;
  }
  if (const std::string number = rank_of_slurm(slices); !number.empty()) return number;
  usage_error("--shard", std::string{"found no number of a task in the environment: none of "} + kArrayNumber + ", " +
                             joined(kRanks, ", ", [](const char* name) { return std::string{name}; }) + ", " +
                             kIndexOfKubernetes + " is set, nor " + kRankOfSlurm +
                             " in a job with a task per slice; name the slice, such as 0/10");
}

/// "2/10": slice 2 of 0 … 9. "auto/10" takes the number from the environment of a job array, of mpirun, of srun or of
/// Kubernetes. Throws a usage error of --shard.
Slice parse_slice(const std::string& text) {
  const std::size_t slash = text.find('/');
  std::string index = text.substr(0, slash);
  if (index == "auto") index = number_of_task(slash == std::string::npos ? "" : text.substr(slash + 1));
  const auto number = whole_number(index);
  const auto count = slash == std::string::npos ? std::nullopt : whole_number(std::string_view{text}.substr(slash + 1));
  if (!number || !count || *number >= *count || *count > kMostSlices) {
    usage_error("--shard",
                "needs a slice and the number of slices, the first of ten being 0/10 and the last 9/10, not '" +
                    (index == text.substr(0, slash) ? text : index + text.substr(slash)) + "'");
  }
  return {static_cast<std::size_t>(*number), static_cast<std::size_t>(*count)};
}

/// A word that is put into a script as it is.
void require_word(const std::string& option, const std::string& text) {
  if (text.starts_with('-')) usage_error(option, "takes no '" + text + "'");
  constexpr std::string_view kPlain{"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._:,-"};
  if (text.find_first_not_of(kPlain) != std::string::npos) {
    usage_error(option, "takes letters, digits and . _ : , - only, not '" + text + "'");
  }
}

}  // namespace

void add_machine_options(CLI::App& command, MachineOptions& options) {
  command.add_flag("--list", options.list, "list the runs, and run nothing");
  const auto take_slice = [&options](const std::string& text) { options.slice = parse_slice(text); };
  command
      .add_option_function<std::string>(
          "--shard", take_slice,
          "run slice I of N alone, from 0/N to N-1/N, into a file of its own below DIR/shards; auto/N takes I from "
          "SLURM_ARRAY_TASK_ID, or from the rank of mpirun")
      ->type_name("I/N");
  command.add_flag("--status", options.status, "say how far the slices are, and run nothing");
  const auto take_folders = [&options](const std::vector<std::string>& given) {
    options.merge = true;
    for (const std::string& folder : given) {
      if (!folder.empty()) options.merged.emplace_back(folder);
    }
  };
  command
      .add_option_function<std::vector<std::string>>(
          "--merge", take_folders,
          "add what the slices have done to the campaign, of all shards of DIR or of these folders")
      ->expected(0, -1)
      ->type_name("[FOLDER...]");
  command.add_flag("--slurm", options.slurm,
                   "submit the runs that are missing as a job array of Slurm, and a merge after it");
  command.add_flag("--set-aside", options.set_aside,
                   "with --merge or --slurm: move damaged shards to DIR/set-aside, and go on without them");
  command.add_flag("--dry-run", options.job.dry_run, "show the script of --slurm, and submit nothing")
      ->needs("--slurm");
  add_value(command, "--partition", options.job.partition, "NAME", "partition of the job array")->needs("--slurm");
  add_value(command, "--time", options.job.time, "LIMIT", "time limit of a task, as sbatch takes it: 2:00:00, 1-12")
      ->needs("--slurm");
  add_value(command, "--cpus", options.job.cpus, "N", "processors of a task, which become its --threads")
      ->needs("--slurm")
      ->check(CLI::Range(1, 4096));
  add_value(command, "--tasks", options.job.tasks, "N", "slices (default: one per run, at most 100)")
      ->needs("--slurm")
      ->check(CLI::Range(std::size_t{1}, kMostSlices));
}

void check_machine_options(const MachineOptions& options) {
  const std::array chosen{std::pair{options.list, "--list"}, std::pair{options.slice.has_value(), "--shard"},
                          std::pair{options.status, "--status"}, std::pair{options.merge, "--merge"},
                          std::pair{options.slurm, "--slurm"}};
  const char* first = nullptr;
  for (const auto& [given, name] : chosen) {
    if (!given) continue;
    if (first != nullptr) usage_error(name, std::string{"cannot be given with "} + first);
    first = name;
  }
  if (options.set_aside && (!(options.merge || options.slurm) || options.job.dry_run || !options.merged.empty())) {
    usage_error("--set-aside",
                "goes with --slurm, or with --merge of the campaign's own shards; it moves no others, and nothing in a "
                "--dry-run");
  }
  require_word("--partition", options.job.partition);
  require_word("--time", options.job.time);
}

}  // namespace saccade::cli
