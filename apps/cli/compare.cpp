// SPDX-License-Identifier: Apache-2.0
// saccade compare: strategies × scenes × seeds, in one SQLite file that an interrupted comparison goes on from.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iomanip>
#include <iostream>
#include <memory>

#include "compare_output.hpp"
#include "comparison.hpp"
#include "exit_status.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "run_folder.hpp"
#include "saccade/core/clock.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr const char* kCampaignFile{"campaign.sqlite"};

json planned_json(const Comparison& comparison, const PlannedRun& run) {
  const ComparedScene& scene = comparison.scenes()[run.scene];
  return {{"scene", scene.name},
          {"scene_hash", scene.hash},
          {"strategy", to_string(run.strategy)},
          {"seed", run.seed},
          {"max_views", run.max_views ? json(*run.max_views) : json(nullptr)},
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
    std::cout << std::left << std::setw(18) << comparison.scenes()[run.scene].name << std::setw(10)
              << to_string(run.strategy) << "seed " << std::setw(8) << run.seed
              << (run.max_views ? std::to_string(*run.max_views) + " views at most" : "as many views as sphere takes")
              << (run.found ? ", done" : "") << '\n';
  }
  const auto found = static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [](const PlannedRun& run) { return run.found; }));
  if (!global.json_to_stdout()) std::cout << runs.size() << " runs, " << found << " of them done\n";
  SACCADE_CHECK(write_json_output(global, json_envelope("compare", global, global.executor(),
                                                        {{"total", clock.elapsed_ms()}}, {{"runs", std::move(rows)}})));
  return static_cast<int>(ExitStatus::done);
}

json result_json(const Comparison& comparison, std::size_t planned, std::size_t done, std::size_t now,
                 std::span<const CampaignSummary> summaries, std::span<const StrategyGap> gaps) {
  json result = comparison_json(summaries, gaps);
  result["out"] = comparison.options().out.string();
  result["campaign"] = (comparison.options().out / kCampaignFile).string();
  result["equal_views"] = comparison.options().equal_views;
  result["seeds"] = comparison.options().seeds;
  result["runs"] = {{"planned", planned}, {"done", done}, {"done_now", now}};
  result["interrupted"] = done < planned;
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
  SACCADE_TRY(const std::size_t now, comparison.run(campaign, executor, progress));
  SACCADE_TRY(const std::vector<CampaignRun> runs, comparison.finished(campaign));
  const std::size_t planned = comparison.scenes().size() * options.seeds.size() * options.strategies.size();
  const std::vector<CampaignSummary> summaries = summarize(runs);
  const std::vector<StrategyGap> gaps = gaps_of(runs, summaries);
  SACCADE_CHECK(write_comparison(out.path(), runs, summaries));
  SACCADE_CHECK(
      write_json_output(global, json_envelope("compare", global, executor, {{"total", clock.elapsed_ms()}},
                                              result_json(comparison, planned, runs.size(), now, summaries, gaps))));
  if (!global.json_to_stdout()) {
    print_comparison(std::cout, summaries, gaps);
    std::cout << "runs      " << now << " done now, " << runs.size() - now << " found\n"
              << "results   " << options.out.string() << '\n';
  }
  if (runs.size() == planned) return static_cast<int>(ExitStatus::done);
  print_error("compare", "interrupted after " + std::to_string(runs.size()) + " of " + std::to_string(planned) +
                             " runs; they are in " + options.out.string() + "; the same command goes on from there");
  return interrupt_status();
}

}  // namespace

void add_compare(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command = program.add_subcommand("compare", "strategies in scenes, with means and confidence intervals");
  auto options = std::make_shared<CompareOptions>();
  add_compare_options(*command, *options);
  command->callback([options, &global, &action] {
    check_compare_options(*options);
    action = [options, &global] { return run_compare(*options, global); };
  });
}

}  // namespace saccade::cli
