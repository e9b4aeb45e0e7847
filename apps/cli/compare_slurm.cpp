// SPDX-License-Identifier: Apache-2.0
#include "compare_slurm.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <optional>

#include "compare_shards.hpp"
#include "saccade/core/fnv1a.hpp"
#include "saccade/io/files/file_io.hpp"
#include "shell_quoted.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;

struct ToolOutput {
  int status{-1};
  std::string text;  ///< from both streams
};

/// Runs a program with these arguments and waits for it.
Result<ToolOutput> run_tool(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += shell_quoted(word) + ' ';
  FILE* stream = ::popen((line + "2>&1").c_str(), "re");
  if (stream == nullptr) return Error{Errc::unavailable, "cannot be started", words.front()};
  ToolOutput output;
  std::array<char, 4096> part{};
  for (std::size_t n = 0; (n = std::fread(part.data(), 1, part.size(), stream)) > 0;)
    output.text.append(part.data(), n);
  const int status = ::pclose(stream);
  output.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  while (!output.text.empty() && output.text.back() == '\n') output.text.pop_back();
  return output;
}

/// Runs a program of Slurm. unavailable where there is none, io_failure where it fails.
Result<std::string> run_slurm(const std::vector<std::string>& words) {
  constexpr int kNotFound{127};
  SACCADE_TRY(const ToolOutput output, run_tool(words));
  if (output.status == kNotFound) {
    return Error{Errc::unavailable, "is not installed; --shard I/N runs slices with any other scheduler",
                 words.front()};
  }
  if (output.status != 0) {
    std::string text = output.text;
    std::replace(text.begin(), text.end(), '\n', ' ');
    return Error{Errc::io_failure, "failed: " + text, words.front()};
  }
  return output.text;
}

Result<fs::path> own_program() {
  std::error_code code;
  fs::path program = fs::read_symlink("/proc/self/exe", code);
  if (code) return Error{Errc::unavailable, "cannot tell where the program is: " + code.message(), "/proc/self/exe"};
  return program;
}

/// One name for each campaign's folder.
std::string job_name(const fs::path& out) {
  Fnv1a hash;
  for (const char c : out.string()) hash.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
  return "saccade-" + hash.text().substr(0, 8);
}

/// Lines that both scripts begin with.
std::string head(const SliceJob& job) {
  std::string text{"#!/bin/bash\n#SBATCH --job-name=" + job.name + '\n'};
  if (!job.options.partition.empty()) text += "#SBATCH --partition=" + job.options.partition + '\n';
  if (!job.options.time.empty()) text += "#SBATCH --time=" + job.options.time + '\n';
  return text + "#SBATCH --output=/dev/null\n#SBATCH --requeue\n";
}

std::string command_of(const SliceJob& job, std::size_t threads) {
  std::string text = shell_quoted(job.program.string());
  for (const std::string& argument : job.arguments) text += ' ' + shell_quoted(argument);
  return text + " --threads " + std::to_string(threads) + " --out " + shell_quoted(job.out.string());
}

std::string begin_in(const SliceJob& job) {
  return "set -e\ncd " + shell_quoted(job.work_folder.string()) + "\nmkdir -p " +
         shell_quoted((job.out / kLogsFolder).string()) + '\n';
}

/// Slices with a run that is not done, and how many such runs there are.
std::vector<std::size_t> slices_to_do(const std::vector<PlannedRun>& plan, std::size_t slices, bool equal_views) {
  std::vector<std::size_t> wanted;
  for (std::size_t index = 0; index < slices; ++index) {
    const std::vector<PlannedRun> runs = runs_of({index, slices}, plan, equal_views);
    if (std::any_of(runs.begin(), runs.end(), [](const PlannedRun& run) { return !run.found; })) {
      wanted.push_back(index);
    }
  }
  return wanted;
}

Result<SliceJob> job_of(const Context& context, const Comparison& comparison, const std::vector<PlannedRun>& plan) {
  const CompareOptions& options = comparison.options();
  SliceJob job;
  SACCADE_TRY(job.program, own_program());
  job.arguments = arguments_of_comparison(context.global().arguments);
  job.out = fs::absolute(options.out).lexically_normal();
  job.work_folder = fs::current_path();
  job.name = job_name(job.out);
  job.options = options.machines.job;
  const std::size_t parts = count_parts(plan, options.equal_views);
  job.slices = job.options.tasks == 0 ? std::clamp<std::size_t>(parts, 1, kMostTasks) : job.options.tasks;
  job.wanted = slices_to_do(plan, job.slices, options.equal_views);
  return job;
}

/// Refuses a campaign of which a job is queued or running.
Status check_queue(const std::string& name) {
  SACCADE_TRY(const std::string queued, run_slurm({"squeue", "--me", "--noheader", "--name", name, "--format", "%A"}));
  if (queued.empty()) return {};
  const std::string job = queued.substr(0, queued.find('\n'));
  return Error{
      Errc::invalid_argument,
      "job " + job + " of this campaign is still queued or running; wait for it, or end it with scancel " + job,
      {}};
}

Result<std::string> submit(const fs::path& script, const std::vector<std::string>& more) {
  std::vector<std::string> words{"sbatch", "--parsable"};
  words.insert(words.end(), more.begin(), more.end());
  words.push_back(script.string());
  SACCADE_TRY(const std::string answer, run_slurm(words));
  return answer.substr(answer.rfind('\n') + 1).substr(0, answer.find(';'));
}

std::string counted(std::size_t count, const std::string& one) {
  return std::to_string(count) + ' ' + one + (count == 1 ? "" : "s");
}

}  // namespace

std::string ranges_of(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += (text.empty() ? "" : ",") + std::to_string(numbers[i]);
    if (last > i) text += '-' + std::to_string(numbers[last]);
    i = last + 1;
  }
  return text;
}

std::vector<std::string> arguments_of_comparison(const std::vector<std::string>& given) {
  static const std::map<std::string, bool> kLeftOut{
      // whether a value follows
      {"--slurm", false}, {"--dry-run", false}, {"--force", false},  {"--partition", true}, {"--time", true},
      {"--cpus", true},   {"--tasks", true},    {"--threads", true}, {"--json", true},      {"--out", true}};
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const std::size_t equals = given[i].find('=');
    const auto option = kLeftOut.find(given[i].substr(0, equals));
    if (option == kLeftOut.end()) {
      kept.push_back(given[i]);
    } else if (option->second && equals == std::string::npos) {
      ++i;
    }
  }
  return kept;
}

std::string array_script(const SliceJob& job) {
  const std::string log = shell_quoted((job.out / kLogsFolder / "slice-").string()) + "\"$SLURM_ARRAY_TASK_ID\".log";
  return head(job) + "#SBATCH --array=" + ranges_of(job.wanted) +
         "\n#SBATCH --cpus-per-task=" + std::to_string(job.options.cpus) + '\n' + begin_in(job) + "exec " +
         command_of(job, job.options.cpus) + " --shard auto/" + std::to_string(job.slices) + " >>" + log + " 2>&1\n";
}

std::string merge_script(const SliceJob& job) {
  return head(job) + begin_in(job) + "exec " + command_of(job, 1) + " --merge >>" +
         shell_quoted((job.out / kLogsFolder / "merge.log").string()) + " 2>&1\n";
}

Result<Outcome> submit_slices(Context& context, const Comparison& comparison) {
  const CompareOptions& options = comparison.options();
  const std::vector<fs::path> shards = shard_files(options.out);
  if (options.machines.job.dry_run) {
    SACCADE_TRY(const CampaignIndex found, done_in(options.out, shards));
    SACCADE_TRY(const SliceJob job, job_of(context, comparison, comparison.plan(found)));
    const std::string script = job.wanted.empty() ? std::string{"# all runs are done\n"} : array_script(job);
    return Outcome{.result = {{"slices", job.wanted}, {"of", job.slices}, {"script", script}},
                   .text = script + "# when it has ended: " + command_of(job, 1) + " --merge\n"};
  }
  SACCADE_CHECK(context.open_folder());
  const fs::path out = fs::absolute(options.out).lexically_normal();
  SACCADE_CHECK(check_queue(job_name(out)));
  SACCADE_TRY(const Campaign campaign, Campaign::open(options.out / kCampaignFile));
  SACCADE_TRY(const CampaignMerge merged,
              merge_shards(comparison, shards, [&campaign]() -> Result<const Campaign*> { return &campaign; }));
  CampaignIndex found;
  SACCADE_CHECK(found.add(campaign));
  const std::vector<PlannedRun> plan = comparison.plan(found);
  SACCADE_TRY(const SliceJob job, job_of(context, comparison, plan));
  const auto missing = static_cast<std::size_t>(
      std::count_if(plan.begin(), plan.end(), [](const PlannedRun& run) { return !run.found; }));
  nlohmann::json result{{"out", options.out.string()},
                        {"runs", {{"planned", plan.size()}, {"missing", missing}, {"merged_now", merged.added}}},
                        {"slices", job.wanted},
                        {"of", job.slices}};
  if (job.wanted.empty())
    return Outcome{.result = std::move(result), .text = "all runs are done; nothing was submitted\n"};
  std::error_code code;
  fs::create_directories(options.out / kLogsFolder, code);
  const fs::path array = options.out / kLogsFolder / "array.sh";
  const fs::path merge = options.out / kLogsFolder / "merge.sh";
  SACCADE_CHECK(write_file_atomically(array, array_script(job)));
  SACCADE_CHECK(write_file_atomically(merge, merge_script(job)));
  SACCADE_TRY(const std::string array_job, submit(array, {}));
  SACCADE_TRY(const std::string merge_job, submit(merge, {"--dependency=afterany:" + array_job}));
  result["array_job"] = array_job;
  result["merge_job"] = merge_job;
  return Outcome{.result = std::move(result),
                 .text = "array     job " + array_job + ": " + counted(missing, "run") + " in " +
                         counted(job.wanted.size(), "slice") + "\nmerge     job " + merge_job +
                         ", when it has ended\nlogs      " + (options.out / kLogsFolder).string() + '\n'};
}

}  // namespace saccade::cli
