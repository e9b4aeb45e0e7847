// SPDX-License-Identifier: Apache-2.0
#include "compare_slurm.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <optional>
#include <sstream>

#include "compare_page.hpp"
#include "compare_run.hpp"
#include "compare_set_aside.hpp"
#include "compare_shards.hpp"
#include "options.hpp"
#include "saccade/core/fnv1a.hpp"
#include "saccade/io/files/file_io.hpp"
#include "shell_quoted.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;

struct ToolOutput {
  int status{-1};
  std::string text;    ///< from its standard output
  std::string errors;  ///< from its standard error
};

/// Runs a program with these arguments and waits for it.
Result<ToolOutput> run_tool(const std::vector<std::string>& words) {
  // The shell passes the standard output on as it comes; behind it, after a NUL, it prints what was on standard error.
  // Two variables would change what sbatch does: the merge must not become an array, and nothing waits for a job.
  std::string line{"unset SBATCH_ARRAY_INX SBATCH_WAIT; exec 3>&1; errors=$("};
  for (const std::string& word : words) line += shell_quoted(word) + ' ';
  line += "2>&1 >&3 3>&-); status=$?; printf '\\000%s' \"$errors\"; exit $status";
  FILE* stream = ::popen(line.c_str(), "re");
  if (stream == nullptr) return Error{Errc::unavailable, "cannot be started", words.front()};
  ToolOutput output;
  std::array<char, 4096> part{};
  for (std::size_t n = 0; (n = std::fread(part.data(), 1, part.size(), stream)) > 0;)
    output.text.append(part.data(), n);
  const int status = ::pclose(stream);
  output.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (const std::size_t end = output.text.find('\0'); end != std::string::npos) {
    output.errors = output.text.substr(end + 1);
    output.text.resize(end);
  }
  return output;
}

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// Runs a program of Slurm, and returns the lines of its standard output. unavailable where there is none, io_failure
/// where it fails.
Result<std::vector<std::string>> run_slurm(const std::vector<std::string>& words) {
  constexpr int kNotFound{127};
  SACCADE_TRY(const ToolOutput output, run_tool(words));
  if (output.status == kNotFound) {
    return Error{Errc::unavailable, "is not installed; --shard I/N runs slices with any other scheduler",
                 words.front()};
  }
  if (output.status != 0) {
    return Error{Errc::io_failure, "failed: " + one_line(output.errors.empty() ? output.text : output.errors),
                 words.front()};
  }
  std::vector<std::string> lines;
  std::istringstream text{output.text};
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

/// "123" of "123" and of "123;cluster"; nullopt for any other line.
std::optional<std::string> job_number(const std::string& line) {
  const std::size_t end = line.find_first_not_of("0123456789");
  if (end == 0 || line.empty() || (end != std::string::npos && line[end] != ';')) return std::nullopt;
  return line.substr(0, end);
}

Result<fs::path> own_program() {
  std::error_code code;
  fs::path program = fs::read_symlink("/proc/self/exe", code);
  if (code) return Error{Errc::unavailable, "cannot tell where the program is: " + code.message(), "/proc/self/exe"};
  return program;
}

/// One name for each campaign's folder, however it is spelled.
std::string job_name(const fs::path& out) {
  std::error_code code;
  const fs::path real = fs::weakly_canonical(out, code);
  Fnv1a hash;
  for (const char c : (code ? out : real).string()) hash.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
  return "saccade-" + hash.text().substr(0, 8);
}

/// Seconds before the time limit at which a task is told to keep what it has; Slurm may be a minute early.
constexpr int kWarningBefore_s{60};

/// Minutes of a time limit as sbatch takes it: minutes, minutes:seconds, hours:minutes:seconds, days-hours,
/// days-hours:minutes, days-hours:minutes:seconds; nullopt for none, 0 and words such as UNLIMITED included.
std::optional<double> minutes_of(const std::string& limit) {
  const std::size_t dash = limit.find('-');
  std::vector<double> parts;
  std::istringstream text{dash == std::string::npos ? limit : limit.substr(dash + 1)};
  for (std::string part; std::getline(text, part, ':');) {
    const auto number = whole_number(part);
    if (!number) return std::nullopt;
    parts.push_back(static_cast<double>(*number));
  }
  parts.resize(3, 0.0);
  const bool hours_first = dash != std::string::npos || std::count(limit.begin(), limit.end(), ':') == 2;
  const double minutes = hours_first ? 60.0 * parts[0] + parts[1] + parts[2] / 60.0 : parts[0] + parts[1] / 60.0;
  const auto days = whole_number(limit.substr(0, dash));
  const double all = minutes + (dash == std::string::npos || !days ? 0.0 : 1440.0 * static_cast<double>(*days));
  return all > 0.0 ? std::optional{all} : std::nullopt;
}

/// Tells whether a time limit leaves time for work before the warning.
bool leaves_time_to_warn(const std::string& limit) {
  constexpr double kLeast_min{5.0};
  return minutes_of(limit).value_or(kLeast_min) >= kLeast_min;
}

/// Options of sbatch for both jobs. They stand in the script, and are given to sbatch as well, since there they count
/// more than its environment.
std::vector<std::string> options_of_both(const SliceJob& job) {
  std::vector<std::string> options{"--job-name=" + job.name};
  if (!job.options.partition.empty()) options.push_back("--partition=" + job.options.partition);
  if (!job.options.time.empty()) options.push_back("--time=" + job.options.time);
  options.insert(options.end(), {"--output=/dev/null", "--requeue"});
  return options;
}

std::vector<std::string> options_of_array(const SliceJob& job) {
  std::vector<std::string> options = options_of_both(job);
  if (leaves_time_to_warn(job.options.time)) options.push_back("--signal=B:USR2@" + std::to_string(kWarningBefore_s));
  options.push_back("--array=" + ranges_of(job.wanted));
  options.push_back("--cpus-per-task=" + std::to_string(job.options.cpus));
  return options;
}

std::vector<std::string> options_of_merge(const SliceJob& job) {
  std::vector<std::string> options = options_of_both(job);
  options.emplace_back("--cpus-per-task=1");
  return options;
}

std::string head(const std::vector<std::string>& options) {
  std::string text{"#!/bin/bash\n"};
  for (const std::string& option : options) text += "#SBATCH " + option + '\n';
  return text;
}

std::string command_of(const SliceJob& job, std::size_t threads) {
  std::string text = shell_quoted(job.program.string());
  for (const std::string& argument : job.arguments) text += ' ' + shell_quoted(argument);
  return text + " --threads " + std::to_string(threads) + " --out " + shell_quoted(job.out.string());
}

/// The script ends at once, and its job fails, where its node has no DIR; one that it made would be its own. Slurm
/// keeps the reason as the job's comment, since there is no log. From then on the script writes to its log, so that a
/// working folder that the node cannot reach leaves a trace.
std::string begin_in(const SliceJob& job, const std::string& log) {
  return "set -e\nif ! test -d " + shell_quoted(job.out.string()) +
         "; then\n  scontrol update \"JobId=$SLURM_JOB_ID\" \"Comment=node $SLURMD_NODENAME has no \"" +
         shell_quoted(job.out.string()) + "\n  exit 1\nfi\nmkdir -p " + shell_quoted((job.out / kLogsFolder).string()) +
         "\nexec >>" + log + " 2>&1\ncd " + shell_quoted(job.work_folder.string()) + '\n';
}

/// Waits for the task of the script, and queues it again where the time limit has ended it (128 + SIGUSR2). Slurm sends
/// other signals to all processes of a job, and SIGUSR2 to the script alone.
constexpr const char* kWaitForTask{
    "task=$!\n"
    "trap 'kill -USR2 \"$task\" 2>/dev/null || :' USR2\n"
    "trap : INT TERM\n"
    "while :; do\n"
    "  status=0\n"
    "  wait \"$task\" || status=$?\n"
    "  kill -0 \"$task\" 2>/dev/null || break\n"
    "done\n"
    "if [ \"$status\" -eq 140 ]; then\n"
    "  echo 'the time limit is near; the slice is queued again'\n"
    "  scontrol requeue \"${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID\"\n"
    "fi\n"
    "exit \"$status\"\n"};

/// Slices with a run that is not done.
std::vector<std::size_t> slices_to_do(const SliceCounter& counter, std::size_t slices) {
  std::vector<std::size_t> wanted;
  for (std::size_t index = 0; index < slices; ++index) {
    const SliceRuns runs = counter.of({index, slices});
    if (runs.done < runs.planned) wanted.push_back(index);
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
  const SliceCounter counter{plan, options.equal_views};
  const std::size_t most = job.options.tasks == 0 ? kMostTasks : job.options.tasks;
  job.slices = std::clamp<std::size_t>(counter.parts(), 1, most);
  job.wanted = slices_to_do(counter, job.slices);
  return job;
}

/// Refuses a campaign of which a job is queued or running.
Status check_queue(const std::string& name) {
  SACCADE_TRY(const std::vector<std::string> queued,
              run_slurm({"squeue", "--me", "--noheader", "--name", name, "--format", "%A"}));
  for (const std::string& line : queued) {
    const auto job = job_number(line.substr(0, line.find_last_not_of(' ') + 1));
    if (!job) continue;
    return Error{
        Errc::invalid_argument,
        "job " + *job + " of this campaign is still queued or running; wait for it, or end it with scancel " + *job,
        {}};
  }
  return {};
}

/// @param options  of sbatch
/// @return the job's number
Result<std::string> submit(const fs::path& script, const std::vector<std::string>& options) {
  std::vector<std::string> words{"sbatch", "--parsable"};
  words.insert(words.end(), options.begin(), options.end());
  words.push_back(script.string());
  SACCADE_TRY(const std::vector<std::string> answer, run_slurm(words));
  for (const std::string& line : answer) {
    if (const auto job = job_number(line)) return *job;
  }
  return Error{Errc::io_failure,
               "gave no number of a job (" + (answer.empty() ? "it printed nothing" : '"' + answer.front() + '"') +
                   "); squeue --me tells whether there is one",
               words.front()};
}

struct SubmittedJobs {
  std::string array;
  std::string merge;
};

/// Writes both scripts into DIR/logs, and submits them.
Result<SubmittedJobs> submit_jobs(const SliceJob& job) {
  std::error_code code;
  fs::create_directories(job.out / kLogsFolder, code);
  const fs::path array = job.out / kLogsFolder / "array.sh";
  const fs::path merge = job.out / kLogsFolder / "merge.sh";
  SACCADE_CHECK(write_file_atomically(array, array_script(job)));
  SACCADE_CHECK(write_file_atomically(merge, merge_script(job)));
  Result<std::string> array_job = submit(array, options_of_array(job));
  if (!array_job) {
    Error error = array_job.error();
    if (error.message.find("Invalid job array specification") != std::string::npos) {
      error.message +=
          "; the cluster takes no task number from its MaxArraySize on (scontrol show config): pass --tasks"
          " with at most that number";
    }
    return error;
  }
  std::vector<std::string> options = options_of_merge(job);
  options.push_back("--dependency=afterany:" + *array_job);
  Result<std::string> merge_job = submit(merge, options);
  if (!merge_job) {
    Error error = merge_job.error();
    error.message += "; the array is queued as job " + *array_job +
                     ", but not the merge after it: give the same command with --merge instead of --slurm when the"
                     " array has ended, or end it with scancel " +
                     *array_job;
    return error;
  }
  return SubmittedJobs{*array_job, *merge_job};
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
  static const std::map<std::string, bool> kLeftOut{// whether a value follows
                                                    {"--slurm", false}, {"--set-aside", false}, {"--dry-run", false},
                                                    {"--force", false}, {"--partition", true},  {"--time", true},
                                                    {"--cpus", true},   {"--tasks", true},      {"--threads", true},
                                                    {"--json", true},   {"--out", true}};
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
  return head(options_of_array(job)) + begin_in(job, log) + command_of(job, job.options.cpus) + " --shard auto/" +
         std::to_string(job.slices) + " </dev/null &\n" + kWaitForTask;
}

std::string merge_script(const SliceJob& job) {
  return head(options_of_merge(job)) + begin_in(job, shell_quoted((job.out / kLogsFolder / "merge.log").string())) +
         "exec " + command_of(job, 1) + " --merge\n";
}

Result<Outcome> submit_slices(Context& context, const Comparison& comparison) {
  const CompareOptions& options = comparison.options();
  if (options.machines.job.dry_run) {
    const std::vector<fs::path> shards = shard_files(options.out);
    SACCADE_TRY(const CampaignIndex found, done_in(options.out, shards));
    SACCADE_TRY(const SliceJob job, job_of(context, comparison, comparison.plan(found)));
    const std::string script = job.wanted.empty() ? std::string{"# all runs are done\n"} : array_script(job);
    return Outcome{.result = {{"slices", job.wanted}, {"of", job.slices}, {"script", script}},
                   .text = script + "# when it has ended: " + command_of(job, 1) + " --merge\n"};
  }
  SACCADE_CHECK(open_campaign_folder(context));
  const fs::path out = fs::absolute(options.out).lexically_normal();
  SACCADE_CHECK(check_queue(job_name(out)));
  if (options.machines.set_aside) SACCADE_CHECK(set_aside_damaged(context, options.out));
  std::error_code ignored;
  const bool was_there = fs::exists(options.out / kCampaignFile, ignored);
  SACCADE_TRY(const Campaign campaign, Campaign::open(options.out / kCampaignFile));
  const Result<ShardMerge> merge = merge_shards(comparison, shard_files(options.out),
                                                [&campaign]() -> Result<const Campaign*> { return &campaign; });
  if (!merge) {
    if (!was_there) fs::remove(options.out / kCampaignFile, ignored);
    refresh_page(context, comparison);
    return with_set_aside_hint(merge.error(), options);
  }
  const ShardMerge& merged = *merge;
  if (const std::string left_out = left_out_text(merged); !left_out.empty()) context.bar().note(left_out);
  CampaignIndex found;
  SACCADE_CHECK(found.add(campaign));
  const std::vector<PlannedRun> plan = comparison.plan(found);
  SACCADE_TRY(const SliceJob job, job_of(context, comparison, plan));
  const std::size_t missing = plan.size() - done_of(plan);
  nlohmann::json result{{"out", options.out.string()},
                        {"runs", {{"planned", plan.size()}, {"missing", missing}, {"merged_now", merged.added}}},
                        {"slices", job.wanted},
                        {"of", job.slices}};
  if (job.wanted.empty())
    return Outcome{.result = std::move(result), .text = "all runs are done; nothing was submitted\n"};
  SACCADE_TRY(const SubmittedJobs jobs, submit_jobs(job));
  refresh_page(context, comparison, job.slices);
  result["array_job"] = jobs.array;
  result["merge_job"] = jobs.merge;
  return Outcome{.result = std::move(result),
                 .text = "array     job " + jobs.array + ": " + counted(missing, "run") + " in " +
                         counted(job.wanted.size(), "slice") + "\nmerge     job " + jobs.merge +
                         ", when it has ended\nlogs      " + (options.out / kLogsFolder).string() + "\npage      " +
                         (options.out / kPageFile).string() + '\n'};
}

}  // namespace saccade::cli
