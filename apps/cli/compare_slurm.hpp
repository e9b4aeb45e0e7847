// SPDX-License-Identifier: Apache-2.0
#pragma once
// --slurm of campaigns: the script of a job array, and its submission.

#include "compare_slices.hpp"
#include "context.hpp"

namespace saccade::cli {

/// A job array whose tasks run slices of a comparison.
struct SliceJob {
  std::string name;                    ///< for the job; each campaign has one
  std::filesystem::path program;       ///< absolute
  std::vector<std::string> arguments;  ///< the command, but not where and how it runs
  std::filesystem::path out;           ///< absolute
  std::filesystem::path work_folder;   ///< absolute; relative names in the arguments start there
  std::size_t slices{1};
  std::vector<std::size_t> wanted;  ///< those to be run, ascending
  SlurmOptions options;
};

/// Returns the script for sbatch. A task runs slice SLURM_ARRAY_TASK_ID, and its output goes to DIR/logs.
[[nodiscard]] std::string array_script(const SliceJob& job);
/// Returns the script that merges the shards.
[[nodiscard]] std::string merge_script(const SliceJob& job);
/// "0-3,7": numbers and ranges of them, for --array.
[[nodiscard]] std::string ranges_of(const std::vector<std::size_t>& numbers);
/// The arguments of the comparison alone: without those of submission, of --out and of the scaffold.
[[nodiscard]] std::vector<std::string> arguments_of_comparison(const std::vector<std::string>& given);

/// Merges what there is, and submits the slices that lack runs as a job array, and a job that merges them when it has
/// ended; with --dry-run shows the scripts instead. Refuses while a job of the campaign is queued or running.
/// unavailable without Slurm.
[[nodiscard]] Result<Outcome> submit_slices(Context& context, const Comparison& comparison);

}  // namespace saccade::cli
