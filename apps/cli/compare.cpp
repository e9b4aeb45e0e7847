// SPDX-License-Identifier: Apache-2.0
// saccade compare: strategies × scenes × noises × seeds, in one SQLite file that an interrupted comparison goes on
// from.
#include <algorithm>
#include <iomanip>
#include <sstream>

#include "compare_report.hpp"
#include "compare_run.hpp"
#include "compare_shards.hpp"
#include "compare_slurm.hpp"
#include "context.hpp"
#include "server/report_file.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr const char* kReportFile{"index.html"};

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
  SACCADE_TRY(const CampaignIndex done, done_in(comparison.options().out, {}));
  const std::vector<PlannedRun> runs = comparison.plan(done);
  json rows = json::array();
  std::ostringstream text;
  text << std::left;
  const int scene_width = column_width(comparison.scenes(), &ComparedScene::name);
  const int strategy_width = column_width(runs, [](const PlannedRun& run) { return run.strategy.name; });
  for (const PlannedRun& run : runs) {
    rows.push_back(planned_json(comparison, run));
    text << std::setw(scene_width) << comparison.scenes()[run.scene].name << std::setw(strategy_width)
         << run.strategy.name << std::setw(12) << run.noise << "seed " << std::setw(8) << run.seed
         << (run.max_views ? std::to_string(*run.max_views) + " views at most" : "as many views as sphere takes")
         << (run.found ? ", done" : "") << '\n';
  }
  const auto found = std::count_if(runs.begin(), runs.end(), [](const PlannedRun& run) { return run.found; });
  text << runs.size() << " runs, " << found << " of them done\n";
  return Outcome{.result = {{"runs", std::move(rows)}}, .text = text.str()};
}

json result_json(const Comparison& comparison, std::size_t planned, const ComparedRuns& compared) {
  const CompareOptions& options = comparison.options();
  json result = comparison_json(compared);
  result["out"] = options.out.string();
  result["campaign"] = (options.out / kCampaignFile).string();
  result["robot"] = comparison.robot_name();
  result["max_views"] = compared.budget;
  result["equal_views"] = options.equal_views;
  result["seeds"] = options.seeds;
  result["runs"] = {{"planned", planned}, {"done", compared.runs.size()}};
  result["interrupted"] = compared.runs.size() < planned;
  return result;
}

class Compare final : public Command {
 public:
  explicit Compare(const Planners& planners) : planners_{&planners} {}

  [[nodiscard]] CommandInfo info() const override {
    return {"compare", "compares strategies in scenes, with means and confidence intervals"};
  }

  void declare(Options& options) override {
    options.folder({.help = "folder for the results; runs that are in it already are not repeated",
                    .files = {kShardsFolder, kLogsFolder},
                    .marker = kCampaignFile,
                    .required = true,
                    .opened_by_command = true});
    add_compare_options(options.group(), compare_, *planners_);
  }

  void check(const GlobalOptions& global) override { check_compare_options(compare_, global.planners); }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    compare_.out = context.out();
    SACCADE_TRY(const Comparison comparison, Comparison::create(compare_));
    if (compare_.list) return list_runs(comparison);
    if (compare_.status) return slice_status(comparison);
    if (compare_.slice) return run_slice(context, comparison);
    if (compare_.slurm) return submit_slices(context, comparison);
    if (compare_.merge) return merge(context, comparison);
    return run_here(context, comparison);
  }

 private:
  /// Runs what is missing, on this machine.
  static Result<Outcome> run_here(Context& context, const Comparison& comparison) {
    SACCADE_TRY(const ComparisonRun done, run_comparison(context, comparison));
    SACCADE_TRY(Outcome outcome, report(context, comparison, done.campaign, done.found, {{"done_now", done.now}}));
    outcome.cut_short = cut_short(context, outcome.result.at("runs").at("done").get<std::size_t>(), done.planned);
    return outcome;
  }

  static Result<Outcome> merge(Context& context, const Comparison& comparison) {
    SACCADE_TRY(const std::vector<std::filesystem::path> shards, shards_to_merge(comparison.options()));
    std::optional<Campaign> campaign;
    const auto open = [&]() -> Result<const Campaign*> {
      SACCADE_CHECK(context.open_folder());
      SACCADE_TRY(campaign, Campaign::open(*context.folder() / kCampaignFile));
      return &*campaign;
    };
    SACCADE_TRY(const CampaignMerge merged, merge_shards(comparison, shards, open));
    CampaignIndex found;
    SACCADE_CHECK(found.add(*campaign));
    SACCADE_TRY(Outcome outcome,
                report(context, comparison, *campaign, found,
                       {{"merged_now", merged.added}, {"known", merged.known}, {"shards", shards.size()}}));
    return outcome;
  }

  /// Writes tables, pictures and the page of what the campaign has.
  /// @param found   all runs of the campaign
  /// @param counts  what has been done now; goes to the runs of the result
  static Result<Outcome> report(Context& context, const Comparison& comparison, const Campaign& campaign,
                                const CampaignIndex& found, const json& counts) {
    const RunFolder& out = *context.folder();
    context.lap("runs");
    SACCADE_TRY(std::vector<CampaignEntry> runs, comparison.finished(campaign, found));
    context.lap("read");
    const CompareOptions& options = comparison.options();
    const std::size_t done = runs.size();
    const std::size_t planned =
        comparison.scenes().size() * options.noises.size() * options.seeds.size() * options.strategies.size();
    const ComparedRuns results = compared(std::move(runs), comparison.budget());
    context.lap("statistics");
    SACCADE_CHECK(write_comparison(out.path(), results));
    context.lap("tables");
    std::ostringstream text;
    print_comparison(text, results);
    if (counts.contains("done_now")) {
      const auto now = counts.at("done_now").get<std::size_t>();
      text << "runs      " << now << " done now, " << done - now << " found\n";
    } else {
      text << "runs      " << counts.at("merged_now") << " merged now, " << counts.at("known") << " known, " << done
           << " of " << planned << " in the campaign\n";
    }
    text << "report    " << (out / kReportFile).string() << '\n';
    Outcome outcome{.result = result_json(comparison, planned, results), .text = text.str()};
    outcome.result.at("runs").update(counts);
    if (std::filesystem::exists(out / kShardsFolder)) {
      SACCADE_TRY(const std::vector<SliceProgress> slices, progress_of(comparison, comparison.plan(found)));
      outcome.result["slices"] = slices_json(slices);
    }
    SACCADE_CHECK(server::write_report(out / kReportFile, context.document(outcome.result),
                                       comparison_details(comparison, results)));
    return outcome;
  }

  const Planners* planners_;
  CompareOptions compare_;
};

}  // namespace

void add_compare(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command(program, global, action, std::make_shared<Compare>(global.planners));
}

}  // namespace saccade::cli
