// SPDX-License-Identifier: Apache-2.0
// saccade compare: strategies × scenes × noises × seeds, in one SQLite file that an interrupted comparison goes on
// from.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iomanip>
#include <iostream>
#include <memory>

#include "compare_jobs.hpp"
#include "compare_report.hpp"
#include "comparison.hpp"
#include "exit_status.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "run_folder.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr const char* kCampaignFile{"campaign.sqlite"};
constexpr const char* kReportFile{"index.html"};

json planned_json(const Comparison& comparison, const PlannedRun& run) {
  const ComparedScene& scene = comparison.scenes()[run.scene];
  return {{"scene", scene.name}, {"scene_hash", scene.hash}, {"strategy", run.strategy.name},
          {"noise", run.noise},  {"seed", run.seed},         {"max_views", optional_json(run.max_views)},
          {"found", run.found}};
}

/// Writes nothing and makes no folder.
Result<int> list_runs(const Comparison& comparison, const GlobalOptions& global, const Stopwatch& clock) {
  const std::filesystem::path path = comparison.options().out / kCampaignFile;
  std::optional<Campaign> campaign;
  if (std::filesystem::exists(path)) {
    SACCADE_TRY(campaign, Campaign::open(path));
  }
  SACCADE_TRY(const std::vector<PlannedRun> runs, comparison.plan(campaign ? &*campaign : nullptr));
  json rows = json::array();
  for (const PlannedRun& run : runs) {
    rows.push_back(planned_json(comparison, run));
    if (global.json_to_stdout()) continue;
    std::cout << std::left << std::setw(18) << comparison.scenes()[run.scene].name << std::setw(10) << run.strategy.name
              << ' ' << std::setw(12) << run.noise << "seed " << std::setw(8) << run.seed
              << (run.max_views ? std::to_string(*run.max_views) + " views at most" : "as many views as sphere takes")
              << (run.found ? ", done" : "") << '\n';
  }
  const auto found = static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [](const PlannedRun& run) { return run.found; }));
  if (!global.json_to_stdout()) std::cout << runs.size() << " runs, " << found << " of them done\n";
  SACCADE_CHECK(
      write_result("compare", global, global.executor(), {{"total", clock.elapsed_ms()}}, {{"runs", std::move(rows)}}));
  return static_cast<int>(ExitStatus::done);
}

json result_json(const Comparison& comparison, std::size_t planned, std::size_t now, const ComparedRuns& compared) {
  const CompareOptions& options = comparison.options();
  json result = comparison_json(compared);
  result["out"] = options.out.string();
  result["campaign"] = (options.out / kCampaignFile).string();
  result["robot"] = comparison.robot_name();
  result["max_views"] = compared.budget;
  result["equal_views"] = options.equal_views;
  result["seeds"] = options.seeds;
  result["runs"] = {{"planned", planned}, {"done", compared.runs.size()}, {"done_now", now}};
  result["interrupted"] = compared.runs.size() < planned;
  return result;
}

Result<int> run_compare(const CompareOptions& options, const GlobalOptions& global) {
  const Stopwatch clock;
  const Executor executor = global.executor();
  SACCADE_CHECK(check_json_output(global));
  SACCADE_TRY(const Comparison comparison, Comparison::create(options));
  if (options.list) return list_runs(comparison, global, clock);
  SACCADE_TRY(const RunFolder out, RunFolder::open(options.out, {}, kCampaignFile, options.force));
  SACCADE_TRY(const Campaign campaign, Campaign::open(out / kCampaignFile));

  ProgressBar progress{global.quiet};
  for (const std::string& choice : comparison.arm_choices()) progress.note("arm: " + choice);
  SACCADE_TRY(const std::size_t now, run_missing(comparison, campaign, executor.threads(), progress));
  SACCADE_TRY(std::vector<CampaignEntry> runs, comparison.finished(campaign));
  const std::size_t done = runs.size();
  const std::size_t planned =
      comparison.scenes().size() * options.noises.size() * options.seeds.size() * options.strategies.size();
  const ComparedRuns results = compared(std::move(runs), comparison.budget());
  SACCADE_CHECK(write_comparison(out.path(), results));
  const std::string page = comparison_report_html(comparison_report(comparison, results, planned));
  SACCADE_CHECK(write_file_atomically(out / kReportFile, page));
  SACCADE_CHECK(write_result("compare", global, executor, {{"total", clock.elapsed_ms()}},
                             result_json(comparison, planned, now, results)));
  if (!global.json_to_stdout()) {
    print_comparison(std::cout, results);
    std::cout << "runs      " << now << " done now, " << done - now << " found\n"
              << "report    " << (options.out / kReportFile).string() << '\n';
  }
  if (done == planned) return static_cast<int>(ExitStatus::done);
  print_error("compare", "interrupted after " + std::to_string(done) + " of " + std::to_string(planned) +
                             " runs; they are in " + options.out.string() + "; the same command goes on from there");
  return interrupt_status();
}

}  // namespace

void add_compare(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command = program.add_subcommand("compare", "strategies in scenes, with means and confidence intervals");
  auto options = std::make_shared<CompareOptions>();
  add_compare_options(*command, *options, global.planners);
  command->callback([options, &global, &action] {
    check_compare_options(*options, global.planners);
    action = [options, &global] { return run_compare(*options, global); };
  });
}

}  // namespace saccade::cli
