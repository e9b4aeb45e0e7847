// SPDX-License-Identifier: Apache-2.0
// saccade benchmark: published protocols of view planning, each a campaign as of `saccade compare`, with published
// figures beside ours.
#include <algorithm>

#include "benchmark_output.hpp"
#include "compare_run.hpp"
#include "saccade/core/nearest_word.hpp"

namespace saccade::cli {
namespace {

/// The strategies of the program, and ours in its form that plans once.
Planners benchmark_planners(const Planners& planners) {
  Planners all = planners;
  all.add(one_shot(surface_planner()));
  return all;
}

/// "figure" of "figure@12".
std::string object_of(const Scene& scene) { return scene.name.substr(0, scene.name.find('@')); }

/// Leaves the named objects, with all their first views. invalid_argument for one that is not there.
Status keep_only(BenchmarkPlan& plan, const std::vector<std::string>& wanted) {
  std::vector<std::string> objects;
  for (const Scene& scene : plan.scenes) {
    std::string object = object_of(scene);
    if (objects.empty() || objects.back() != object) objects.push_back(std::move(object));
  }
  for (const std::string& name : wanted) {
    if (std::find(objects.begin(), objects.end(), name) != objects.end()) continue;
    const std::vector<std::string_view> known{objects.begin(), objects.end()};
    return Error{Errc::invalid_argument,
                 "there is no object \"" + name + "\"; there are " + joined(objects) + did_you_mean(name, known),
                 "--only"};
  }
  std::erase_if(plan.scenes, [&](const Scene& scene) {
    return std::find(wanted.begin(), wanted.end(), object_of(scene)) == wanted.end();
  });
  return {};
}

/// Measures the finished runs of a protocol with a rule, scene by scene: those of an interrupted campaign, too.
Result<std::vector<MeasuredRun>> measure_runs(Context& context, const Benchmark& benchmark,
                                              const Comparison& comparison, const Campaign& campaign,
                                              const std::vector<CampaignEntry>& runs) {
  std::vector<MeasuredRun> measured;
  const Progress& progress = context.stage("measuring");
  std::size_t scenes_done = 0;
  for (const ComparedScene& scene : comparison.scenes()) {
    progress.report("measuring", scenes_done++, comparison.scenes().size());
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

/// Whether the command line says more than the command.
bool says_more(const CLI::App& command) {
  const std::vector<const CLI::Option*> options = command.get_options();
  return std::any_of(options.begin(), options.end(), [](const CLI::Option* option) { return option->count() > 0; });
}

class BenchmarkCommand final : public Command {
 public:
  BenchmarkCommand() {
    compare_.seed_list = "1";
    compare_.strategy_list.clear();
  }

  [[nodiscard]] CommandInfo info() const override {
    return {"benchmark", "runs published protocols of view planning, with published figures beside ours"};
  }

  void declare(Options& options) override {
    options.value("name", name_, "NAME", "protocol; without it they are listed");
    options.folder(campaign_folder());
    request_ = &options.request();
    options.value("--objects", objects_, "DIR",
                  "folder with the protocol's meshes, which are checked by their MD5; without it stand-ins are made");
    options.value("--strategies", compare_.strategy_list, "LIST",
                  "strategies instead of the protocol's, separated by commas; the first is set beside published "
                  "figures. surface-one-shot chooses all views at once");
    options.value("--only", only_, "LIST", "objects instead of all of the protocol's, separated by commas");
    add_campaign_options(options.group(), compare_);
    command_ = &options.group();
  }

  void check(const GlobalOptions& global) override {
    if (name_.empty()) {
      if (says_more(*command_)) {
        usage_error("name", "a protocol is needed: " + joined(benchmarks(), ", ", &Benchmark::name));
      }
      return;
    }
    const Result<Benchmark> found = find_benchmark(name_);
    if (!found) usage_error("name", found.error().message);
    if (request_->path.empty()) usage_error("--out", "a folder for the results is needed");
    benchmark_ = *found;
    if (!only_.empty()) wanted_ = list_parts("--only", only_);
    check_campaign_options(compare_);
    const std::string names =
        compare_.strategy_list.empty() ? joined(benchmark_.strategies, ",") : compare_.strategy_list;
    compare_.strategies = parse_strategies(names, benchmark_planners(global.planners));
    compare_.robot = benchmark_.robot;
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    if (name_.empty()) return Outcome{.result = benchmark_list_json(), .text = benchmark_list()};
    std::optional<std::filesystem::path> objects;
    if (!objects_.empty()) objects = objects_;
    SACCADE_TRY(BenchmarkPlan plan, plan_benchmark(benchmark_, objects));
    if (!wanted_.empty()) SACCADE_CHECK(keep_only(plan, wanted_));
    SACCADE_TRY(const Comparison comparison, Comparison::create(options_for(context, plan), plan.scenes));
    return run_campaign(context, comparison,
                        [&](const Campaign& campaign, const ComparedRuns& compared, nlohmann::json& result) {
                          return report(context, plan, comparison, campaign, compared, result);
                        });
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

  /// Measures the runs by the rule of the protocol, and sets published figures beside them.
  Result<std::string> report(Context& context, const BenchmarkPlan& plan, const Comparison& comparison,
                             const Campaign& campaign, const ComparedRuns& compared, nlohmann::json& result) const {
    std::vector<MeasuredRun> measured;
    if (benchmark_.rule) {
      SACCADE_TRY(measured, measure_runs(context, benchmark_, comparison, campaign, compared.runs));
      context.lap("measuring");
    }
    const std::vector<BenchmarkRow> table = benchmark_table(benchmark_, measured, compared);
    SACCADE_CHECK(write_benchmark(context.out(), benchmark_, plan, table, measured));
    result["benchmark"] = benchmark_json(benchmark_, plan, table);
    return benchmark_text(benchmark_, plan, table);
  }

  std::string name_;
  std::string objects_;
  std::string only_;
  std::vector<std::string> wanted_;  ///< parts of only_
  const CLI::App* command_{nullptr};
  const FolderRequest* request_{nullptr};
  Benchmark benchmark_;
  CompareOptions compare_;
};

}  // namespace

void add_benchmark(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<BenchmarkCommand>(program, global, action);
}

}  // namespace saccade::cli
