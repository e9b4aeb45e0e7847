// SPDX-License-Identifier: Apache-2.0
// saccade benchmark: published protocols of view planning, each a campaign as of `saccade compare`, with published
// figures beside ours.
#include <algorithm>
#include <set>
#include <sstream>

#include "benchmark_output.hpp"
#include "compare_report.hpp"
#include "compare_run.hpp"
#include "compare_slices.hpp"
#include "server/report_file.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr const char* kBenchmarkPage{"index.html"};

struct BenchmarkOptions {
  std::string name;
  std::string objects;
  std::string strategies;
  std::string seeds{"1"};
  std::string only;
  std::size_t jobs{0};
};

/// The strategies of the program, and ours in its form that plans once.
Planners benchmark_planners(const Planners& planners) {
  Planners all = planners;
  all.add(one_shot(surface_planner()));
  return all;
}

/// Leaves the named objects, with all their first views. invalid_argument for one that is not there.
Status keep_only(BenchmarkPlan& plan, const std::string& list) {
  std::vector<std::string> objects;
  for (const Scene& scene : plan.scenes) {
    const std::string object = scene.name.substr(0, scene.name.find('@'));
    if (objects.empty() || objects.back() != object) objects.push_back(object);
  }
  std::set<std::string> wanted;
  std::istringstream parts{list};
  for (std::string part; std::getline(parts, part, ',');) {
    if (std::find(objects.begin(), objects.end(), part) == objects.end()) {
      return Error{Errc::invalid_argument,
                   "there is no object \"" + part + "\"; there are " +
                       joined(objects, ", ", [](const std::string& name) { return name; }),
                   "--only"};
    }
    wanted.insert(part);
  }
  std::erase_if(plan.scenes,
                [&](const Scene& scene) { return wanted.count(scene.name.substr(0, scene.name.find('@'))) == 0; });
  return {};
}

/// Measures the finished runs of a protocol with a rule, scene by scene: those of an interrupted campaign, too.
Result<std::vector<MeasuredRun>> measure_runs(Context& context, const Benchmark& benchmark,
                                              const Comparison& comparison, const Campaign& campaign,
                                              const std::vector<CampaignEntry>& runs) {
  std::vector<MeasuredRun> measured;
  context.stage("measuring");
  for (const ComparedScene& scene : comparison.scenes()) {
    std::vector<std::vector<Pose>> views;
    std::vector<CampaignKey> keys;
    for (const CampaignEntry& run : runs) {
      if (run.key.scene != scene.name) continue;
      SACCADE_TRY(const std::optional<CampaignEntry> whole, campaign.find(run.key));  // with the poses of its views
      SACCADE_EXPECTS(whole.has_value());
      std::vector<Pose>& taken = views.emplace_back();
      for (const ViewRecord& view : whole->run.views) taken.push_back(view.T_world_camera);
      keys.push_back(run.key);
    }
    if (keys.empty()) continue;
    SACCADE_TRY(std::vector<BenchmarkCurve> curves,
                measure_benchmark(benchmark, scene.rays, comparison.options().run.run, views, context.executor()));
    for (std::size_t i = 0; i < keys.size(); ++i) measured.push_back({keys[i], std::move(curves[i])});
  }
  return measured;
}

class BenchmarkCommand final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {"benchmark", "runs published protocols of view planning, with published figures beside ours"};
  }

  void declare(Options& options) override {
    options.value("name", given_.name, "NAME", "protocol; without it they are listed");
    options.folder({.help = "folder for the results; runs that are in it already are not repeated",
                    .files = {},
                    .marker = kCampaignFile,
                    .opened_by_command = true});
    request_ = &options.request();
    options.value("--objects", given_.objects, "DIR",
                  "folder with the protocol's meshes, which are checked by their MD5; without it stand-ins are made");
    options.value("--strategies", given_.strategies, "LIST",
                  "strategies instead of the protocol's, separated by commas; the first is set beside published "
                  "figures. surface-one-shot chooses all views at once");
    options.value("--only", given_.only, "LIST", "objects instead of all of the protocol's, separated by commas");
    options.value("--seeds", given_.seeds, "LIST", "seeds of noise and chance, each makes one run: 1-10,15");
    options
        .value("--jobs", given_.jobs, "N",
               "runs at once; they share --threads, and the figures do not depend on it (default: one per thread)")
        .range(1, 256);
  }

  void check(const GlobalOptions& global) override {
    if (given_.name.empty()) return;
    const Result<Benchmark> found = find_benchmark(given_.name);
    if (!found) usage_error("name", found.error().message);
    if (request_->path.empty()) usage_error("--out", "a folder for the results is needed");
    benchmark_ = *found;
    compare_.seeds = parse_seeds(given_.seeds);
    const Planners planners = benchmark_planners(global.planners);
    std::string names = given_.strategies;
    if (names.empty()) {
      for (const std::string& name : benchmark_.strategies) names += (names.empty() ? "" : ",") + name;
    }
    compare_.strategies = parse_strategies(names, planners);
    compare_.jobs = given_.jobs;
    compare_.robot = benchmark_.robot;
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    if (given_.name.empty()) return Outcome{.result = benchmark_list_json(), .text = benchmark_list()};
    std::optional<std::filesystem::path> objects;
    if (!given_.objects.empty()) objects = given_.objects;
    SACCADE_TRY(BenchmarkPlan plan, plan_benchmark(benchmark_, objects));
    if (!given_.only.empty()) SACCADE_CHECK(keep_only(plan, given_.only));
    SACCADE_TRY(const Comparison comparison, Comparison::create(options_for(context, plan), plan.scenes));
    SACCADE_TRY(const ComparisonRun done, run_comparison(context, comparison));
    return report(context, plan, comparison, done);
  }

 private:
  CompareOptions options_for(const Context& context, const BenchmarkPlan& plan) const {
    CompareOptions options = compare_;
    options.out = context.out();
    options.run.run = plan.run;
    options.noises = {noise_key(plan.run)};
    // A protocol ends a run after its number of views; scenes of their own are explored as elsewhere.
    if (!benchmark_.has_own_scenes()) options.run.min_gain = plan.run.planner.min_gain;
    return options;
  }

  Result<Outcome> report(Context& context, const BenchmarkPlan& plan, const Comparison& comparison,
                         const ComparisonRun& done) const {
    context.lap("runs");
    SACCADE_TRY(std::vector<CampaignEntry> runs, comparison.finished(done.campaign, done.found));
    std::vector<MeasuredRun> measured;
    if (benchmark_.rule) {
      SACCADE_TRY(measured, measure_runs(context, benchmark_, comparison, done.campaign, runs));
    }
    context.lap("measuring");
    const std::size_t finished = runs.size();
    const ComparedRuns results = compared(std::move(runs), comparison.budget());
    const std::vector<BenchmarkRow> table = benchmark_table(benchmark_, measured, results);
    const RunFolder& out = *context.folder();
    SACCADE_CHECK(write_comparison(out.path(), results));
    SACCADE_CHECK(write_benchmark(out.path(), benchmark_, plan, table, measured));
    context.lap("tables");
    json result = comparison_json(results);
    result["benchmark"] = benchmark_json(benchmark_, plan, table);
    result["out"] = out.path().string();
    result["robot"] = comparison.robot_name();
    result["max_views"] = results.budget;
    result["seeds"] = comparison.options().seeds;
    result["runs"] = {{"planned", done.planned}, {"done", finished}, {"done_now", done.now}};
    result["interrupted"] = finished < done.planned;
    std::string text = benchmark_text(benchmark_, plan, table);
    text += "runs      " + std::to_string(done.now) + " done now, " + std::to_string(finished - done.now) + " found\n";
    text += "report    " + (out / kBenchmarkPage).string() + '\n';
    Outcome outcome{.result = std::move(result), .text = std::move(text)};
    SACCADE_CHECK(server::write_report(out / kBenchmarkPage, context.document(outcome.result),
                                       comparison_details(comparison, results)));
    outcome.cut_short = cut_short(context, finished, done.planned);
    return outcome;
  }

  BenchmarkOptions given_;
  const FolderRequest* request_{nullptr};
  Benchmark benchmark_;
  CompareOptions compare_;
};

}  // namespace

void add_benchmark(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<BenchmarkCommand>(program, global, action);
}

}  // namespace saccade::cli
