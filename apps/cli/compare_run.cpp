// SPDX-License-Identifier: Apache-2.0
#include "compare_run.hpp"

#include <algorithm>
#include <functional>
#include <iomanip>
#include <map>
#include <optional>
#include <sstream>

#include "compare_jobs.hpp"
#include "compare_page.hpp"
#include "compare_report.hpp"
#include "compare_set_aside.hpp"
#include "compare_shards.hpp"
#include "compare_slurm.hpp"
#include "server/report_file.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

json planned_json(const Comparison& comparison, const PlannedRun& run) {
  const ComparedScene& scene = comparison.scenes()[run.scene];
  return {{"scene", scene.name}, {"scene_hash", scene.hash}, {"strategy", run.strategy.name},
          {"noise", run.noise},  {"seed", run.seed},         {"max_views", optional_json(run.max_views)},
          {"found", run.found}};
}

/// Width of a column that holds all of some names, and a gap.
template <class Items, class Name>
int column_width(const Items& items, const Name& name) {
  std::size_t width = 0;
  for (const auto& item : items) width = std::max(width, std::invoke(name, item).size());
  return static_cast<int>(width) + 2;
}

/// Writes nothing, and makes no folder.
Result<Outcome> list_runs(const Comparison& comparison) {
  const std::filesystem::path& out = comparison.options().out;
  std::vector<Error> unreadable;
  SACCADE_TRY(const CampaignIndex done, done_in(out, shard_files(out), &unreadable));
  const std::vector<PlannedRun> runs = comparison.plan(done);
  json rows = json::array();
  std::ostringstream text;
  text << std::left;
  const int scene_width = column_width(comparison.scenes(), &ComparedScene::name);
  const int strategy_width = column_width(runs, [](const PlannedRun& run) { return run.strategy.name; });
  for (const PlannedRun& run : runs) {
    rows.push_back(planned_json(comparison, run));
    text << std::setw(scene_width) << comparison.scenes()[run.scene].name << std::setw(strategy_width)
         << run.strategy.name << std::setw(12) << run.noise << "seed " << std::setw(8) << run.seed << ' '
         << (run.max_views ? std::to_string(*run.max_views) + " views at most" : "as many views as sphere takes")
         << (run.found ? ", done" : "") << '\n';
  }
  text << runs.size() << " runs, " << done_of(runs) << " of them done\n";
  for (const Error& error : unreadable) text << "unreadable: " << error.to_string() << '\n';
  return Outcome{.result = {{"runs", std::move(rows)}}, .text = text.str()};
}

/// A campaign, and what was done for it now.
struct CampaignState {
  Campaign campaign;
  CampaignIndex found;     ///< all its runs
  std::size_t planned{0};  ///< runs of the comparison
  json now;                ///< {done_now}, or after a merge {merged_now, known, shards}, and {left_out} where some are
  std::string left_out{};  ///< for people: runs of shards that a merge left out
};

/// Refuses to do again what slices have done.
Status check_merged(const Comparison& comparison, ProgressBar& bar) {
  const std::filesystem::path& out = comparison.options().out;
  const std::vector<std::filesystem::path> shards = shard_files(out);
  if (shards.empty()) return {};
  std::vector<Error> unreadable;
  SACCADE_TRY(const CampaignIndex merged, done_in(out, {}));
  SACCADE_TRY(const CampaignIndex all, done_in(out, shards, &unreadable));
  for (const Error& error : unreadable) bar.warn("runs of a shard are not seen: " + error.to_string());
  const std::size_t waiting = done_of(comparison.plan(all)) - done_of(comparison.plan(merged));
  if (waiting == 0) return {};
  return Error{Errc::invalid_argument,
               "slices have done " + std::to_string(waiting) +
                   (waiting == 1 ? " run that is not merged" : " runs that are not merged") +
                   " and would be done again; give the same command with --merge first, then this one for the rest",
               out.string()};
}

/// Runs what is missing, on this machine.
Result<CampaignState> run_here(Context& context, const Comparison& comparison) {
  SACCADE_CHECK(check_merged(comparison, context.bar()));
  SACCADE_CHECK(open_campaign_folder(context));
  SACCADE_TRY(Campaign campaign, Campaign::open(*context.folder() / kCampaignFile));
  for (const std::string& choice : comparison.arm_choices()) context.bar().note("arm: " + choice);
  if (const std::string mixed = mixed_camera(comparison.options().run); !mixed.empty()) context.bar().note(mixed);
  CampaignIndex found;
  SACCADE_CHECK(found.add(campaign));
  const std::vector<PlannedRun> plan = comparison.plan(found);
  SACCADE_TRY(const std::size_t now,
              run_missing(comparison, plan, found, campaign, context.executor().threads(), context.bar()));
  return CampaignState{std::move(campaign), std::move(found), plan.size(), {{"done_now", now}}};
}

Result<CampaignState> merge_here(Context& context, const Comparison& comparison) {
  SACCADE_TRY(const std::vector<std::filesystem::path> shards, shards_to_merge(comparison.options()));
  std::optional<Campaign> campaign;
  const auto open = [&]() -> Result<const Campaign*> {
    SACCADE_CHECK(open_campaign_folder(context));
    SACCADE_TRY(campaign, Campaign::open(*context.folder() / kCampaignFile));
    return &*campaign;
  };
  SACCADE_TRY(const ShardMerge merged, merge_shards(comparison, shards, open));
  CampaignIndex found;
  SACCADE_CHECK(found.add(*campaign));
  const std::size_t planned = comparison.plan(found).size();
  json now{{"merged_now", merged.added}, {"known", merged.known}, {"shards", shards.size()}};
  if (merged.left_out > 0) now["left_out"] = merged.left_out;
  return CampaignState{std::move(*campaign), std::move(found), planned, std::move(now), left_out_text(merged)};
}

/// The line of the text that says what was done now.
std::string now_text(const CampaignState& state, std::size_t done) {
  if (state.now.contains("done_now")) {
    const auto now = state.now.at("done_now").get<std::size_t>();
    return "runs      " + std::to_string(now) + " done now, " + std::to_string(done - now) + " found\n";
  }
  return "runs      " + state.now.at("merged_now").dump() + " merged now, " + state.now.at("known").dump() +
         " known, " + std::to_string(done) + " of " + std::to_string(state.planned) + " in the campaign\n" +
         (state.left_out.empty() ? "" : "          " + state.left_out + '\n');
}

/// "12 runs by 0.1.0, 8 by 0.2.0: versions may differ in their figures".
std::string versions_text(const json& versions) {
  std::string text;
  for (const auto& [version, runs] : versions.items()) {
    text += (text.empty() ? "versions  " : ", ") + runs.dump() + (runs == 1 ? " run by " : " runs by ") + version;
  }
  return text.empty() ? text : text + ": versions may differ in their figures\n";
}

Result<Outcome> report(Context& context, const Comparison& comparison, const CampaignState& state,
                       const ReportPart& part) {
  const RunFolder& out = *context.folder();
  context.lap("runs");
  SACCADE_TRY(std::vector<CampaignEntry> runs, comparison.finished(state.campaign, state.found));
  context.lap("read");
  const ComparedRuns results = compared(std::move(runs), comparison.budget());
  context.lap("statistics");
  SACCADE_CHECK(write_comparison(out.path(), results, context.executor()));
  context.lap("tables");
  Outcome outcome{.result = campaign_json(comparison, results, state.planned)};
  outcome.result["runs"].update(state.now);
  SACCADE_TRY(outcome.text, part(state.campaign, results, outcome.result));
  const json versions = outcome.result.value("versions", json());
  outcome.text +=
      now_text(state, results.runs.size()) + versions_text(versions) + "report    " + (out / kPageFile).string() + '\n';
  if (std::filesystem::exists(out / kShardsFolder)) {
    SACCADE_CHECK(add_slices(outcome.result, comparison, results.runs.size(), 0));
  }
  SACCADE_CHECK(
      server::write_report(out / kPageFile, context.document(outcome.result), comparison_details(comparison, results)));
  return outcome;
}

Result<CampaignState> merged_with_page(Context& context, const Comparison& comparison) {
  Result<CampaignState> state = merge_here(context, comparison);
  if (state || shard_records(comparison.options().out).empty()) return state;
  if (state.error().code == Errc::corrupt_data || context.folder() != nullptr) refresh_page(context, comparison);
  return with_set_aside_hint(state.error(), comparison.options());
}

/// Near a time limit there is none left for the page, which the next try writes.
Result<Outcome> run_slice_with_page(Context& context, const Comparison& comparison) {
  const CompareOptions& options = comparison.options();
  Result<Outcome> outcome = run_slice(context, comparison);
  std::error_code ignored;
  const bool began = std::filesystem::exists(shard_folder(options.out, *options.machines.slice), ignored);
  if (began && !time_is_up()) refresh_page(context, comparison);
  return outcome;
}

}  // namespace

FolderOption campaign_folder() {
  return {.help = "folder for the results; runs that are in it already are not repeated",
          .files = {kShardsFolder, kLogsFolder, kSetAsideFolder},
          .marker = kCampaignFile,
          .opened_by_command = true};
}

Status open_campaign_folder(Context& context) {
  const char* marker = campaign_marker(context.out());
  return context.open_folder(marker == nullptr ? "" : marker);
}

Result<Outcome> run_campaign(Context& context, const Comparison& comparison, const ReportPart& part) {
  const MachineOptions& machines = comparison.options().machines;
  if (machines.list) return list_runs(comparison);
  if (machines.status) return slice_status(comparison);
  if (machines.slice) return run_slice_with_page(context, comparison);
  if (machines.slurm) return submit_slices(context, comparison);
  if (machines.set_aside) SACCADE_CHECK(set_aside_damaged(context, comparison.options().out));
  SACCADE_TRY(const CampaignState state,
              machines.merge ? merged_with_page(context, comparison) : run_here(context, comparison));
  SACCADE_TRY(Outcome outcome, report(context, comparison, state, part));
  const auto done = outcome.result.at("runs").at("done").get<std::size_t>();
  if (!machines.merge && done < state.planned) {
    outcome.cut_short = "interrupted after " + std::to_string(done) + " of " + std::to_string(state.planned) +
                        " runs; they are in " + context.out().string() + "; the same command goes on from there";
  }
  return outcome;
}

}  // namespace saccade::cli
