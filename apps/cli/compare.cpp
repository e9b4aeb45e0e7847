// SPDX-License-Identifier: Apache-2.0
// saccade compare: strategies × scenes × noises × seeds, in one SQLite file that an interrupted comparison goes on
// from.
#include <algorithm>
#include <iomanip>
#include <sstream>

#include "compare_jobs.hpp"
#include "compare_report.hpp"
#include "comparison.hpp"
#include "context.hpp"
#include "server/report_file.hpp"

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

/// Width of a column that holds all of some names, and a gap.
template <class Items, class Name>
int column_width(const Items& items, const Name& name) {
  std::size_t width = 0;
  for (const auto& item : items) width = std::max(width, std::invoke(name, item).size());
  return static_cast<int>(width) + 2;
}

/// Writes nothing and makes no folder.
Result<Outcome> list_runs(const Comparison& comparison) {
  const std::filesystem::path path = comparison.options().out / kCampaignFile;
  std::optional<Campaign> campaign;
  if (std::filesystem::exists(path)) {
    SACCADE_TRY(campaign, Campaign::open(path));
  }
  SACCADE_TRY(const std::vector<PlannedRun> runs, comparison.plan(campaign ? &*campaign : nullptr));
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

class Compare final : public Command {
 public:
  explicit Compare(const Planners& planners) : planners_{&planners} {}

  [[nodiscard]] CommandInfo info() const override {
    return {"compare", "compares strategies in scenes, with means and confidence intervals"};
  }

  void declare(Options& options) override {
    options.folder({.help = "folder for the results; runs that are in it already are not repeated",
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
    SACCADE_CHECK(context.open_folder());
    const RunFolder& out = *context.folder();
    SACCADE_TRY(const Campaign campaign, Campaign::open(out / kCampaignFile));

    for (const std::string& choice : comparison.arm_choices()) context.bar().note("arm: " + choice);
    if (const std::string mixed = mixed_camera(compare_.run); !mixed.empty()) context.bar().note(mixed);
    SACCADE_TRY(const std::size_t now, run_missing(comparison, campaign, context.executor().threads(), context.bar()));
    SACCADE_TRY(std::vector<CampaignEntry> runs, comparison.finished(campaign));
    const std::size_t done = runs.size();
    const std::size_t planned =
        comparison.scenes().size() * compare_.noises.size() * compare_.seeds.size() * compare_.strategies.size();
    const ComparedRuns results = compared(std::move(runs), comparison.budget());
    SACCADE_CHECK(write_comparison(out.path(), results));
    std::ostringstream text;
    print_comparison(text, results);
    text << "runs      " << now << " done now, " << done - now << " found\n"
         << "report    " << (out / kReportFile).string() << '\n';
    Outcome outcome{.result = result_json(comparison, planned, now, results), .text = text.str()};
    SACCADE_CHECK(server::write_report(out / kReportFile, context.document(outcome.result),
                                       comparison_details(comparison, results)));
    if (done < planned) {
      outcome.cut_short = "interrupted after " + std::to_string(done) + " of " + std::to_string(planned) +
                          " runs; they are in " + context.out().string() + "; the same command goes on from there";
    }
    return outcome;
  }

 private:
  const Planners* planners_;
  CompareOptions compare_;
};

}  // namespace

void add_compare(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command(program, global, action, std::make_shared<Compare>(global.planners));
}

}  // namespace saccade::cli
