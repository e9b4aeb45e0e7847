// SPDX-License-Identifier: Apache-2.0
// saccade benchmark: published protocols of view planning, each a campaign as of `saccade compare`, with published
// figures beside ours.
#include <algorithm>
#include <set>

#include "benchmark_output.hpp"
#include "compare_run.hpp"
#include "compare_shards.hpp"
#include "saccade/core/nearest_word.hpp"
#include "saccade/trial/benchmark_objects.hpp"

namespace saccade::cli {
namespace {

/// The strategies of the program, and ours in its form that plans once.
Planners benchmark_planners(const Planners& planners) {
  Planners all = planners;
  all.add(one_shot(surface_planner()));
  return all;
}

/// Names of the objects that a protocol may have.
std::vector<std::string> object_names(const Benchmark& benchmark, bool from_folder,
                                      const std::vector<std::filesystem::path>& own) {
  if (benchmark.has_own_scenes()) return benchmark.scenes;
  if (!own.empty()) {
    Result<std::vector<std::string>> names = own_object_names(own);
    if (!names) usage_error("--meshes", names.error().context + ": " + names.error().message);
    return std::move(*names);
  }
  if (!from_folder) return benchmark.stand_ins;
  std::vector<std::string> names;
  for (const BenchmarkMesh& mesh : benchmark.meshes) names.push_back(std::filesystem::path{mesh.file}.stem().string());
  return names;
}

/// Ending of the names of an object's scenes: "@4", "@12" …; nothing where there is one scene.
std::vector<std::string> start_names(const Benchmark& benchmark) {
  std::vector<std::string> names;
  if (benchmark.starts == 1) return names;
  const Result<BenchmarkPlan> plan = plan_benchmark(benchmark, std::nullopt);  // they are equal for all objects
  if (!plan) usage_error("--only", plan.error().message);
  const std::string first = object_of(benchmark, plan->scenes.front().name);
  for (const Scene& scene : plan->scenes) {
    if (object_of(benchmark, scene.name) == first) names.push_back(scene.name.substr(first.size()));
  }
  return names;
}

/// Throws a usage error for what is neither an object nor an object and one of its first views.
void check_wanted(const std::vector<std::string>& wanted, const Benchmark& benchmark,
                  const std::vector<std::string>& objects) {
  std::vector<std::string> names = objects;
  for (const std::string& start : start_names(benchmark)) {
    for (const std::string& object : objects) names.push_back(object + start);
  }
  for (const std::string& name : wanted) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    std::string message = "there is no object \"" + name + "\"; there are " + joined(objects);
    if (names.size() > objects.size()) message += "; one first view of an object is such as " + names[objects.size()];
    usage_error("--only", message + did_you_mean(name, std::vector<std::string_view>{names.begin(), names.end()}));
  }
}

/// The mesh files that --meshes names, those of its folders included, each once. What exists under the whole text is no
/// list: there may be a comma in its name.
std::vector<std::filesystem::path> named_meshes(const std::string& text) {
  std::vector<std::filesystem::path> files;
  std::set<std::filesystem::path> seen;
  std::error_code ignored;
  const auto add = [&](const std::filesystem::path& file) {
    const std::filesystem::path whole = std::filesystem::weakly_canonical(file, ignored);
    if (seen.insert(whole.empty() ? file : whole).second) files.push_back(file);
  };
  const bool is_one = std::filesystem::exists(text, ignored);
  for (const std::string& name : is_one ? std::vector{text} : list_parts("--meshes", text)) {
    if (std::filesystem::is_directory(name, ignored)) {
      const auto found = mesh_files(name);
      if (!found) usage_error("--meshes", found.error().context + ": " + found.error().message);
      std::for_each(found->begin(), found->end(), add);
      continue;
    }
    if (!is_mesh_file(name))
      usage_error("--meshes", name + ": is neither a folder nor a mesh (PLY, STL, OBJ, GLB, glTF, OFF, DAE)");
    add(name);
  }
  return files;
}

/// Leaves the named objects, with all their first views, and the named scenes. not_found for one whose mesh is not
/// in the folder.
Status keep_only(BenchmarkPlan& plan, const Benchmark& benchmark, const std::vector<std::string>& wanted,
                 const std::string& folder) {
  const auto is = [&benchmark](const Scene& scene, const std::string& name) {
    return name == scene.name || name == object_of(benchmark, scene.name);
  };
  for (const std::string& name : wanted) {
    if (std::any_of(plan.scenes.begin(), plan.scenes.end(), [&](const Scene& scene) { return is(scene, name); }))
      continue;
    return Error{Errc::not_found,
                 "there is no mesh of " + name + " here; there are " + joined(objects_of(benchmark, plan.scenes)),
                 folder};
  }
  std::erase_if(plan.scenes, [&](const Scene& scene) {
    return std::none_of(wanted.begin(), wanted.end(), [&](const std::string& name) { return is(scene, name); });
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

/// The protocols, a line each.
std::string benchmark_list() {
  std::size_t width = 0;
  for (const Benchmark& benchmark : benchmarks()) width = std::max(width, benchmark.name.size() + 2);
  std::string text;
  for (const Benchmark& benchmark : benchmarks())
    text += benchmark.name + std::string(width - benchmark.name.size(), ' ') + benchmark.text + '\n';
  return text;
}

nlohmann::json benchmark_list_json() {
  nlohmann::json all = nlohmann::json::array();
  for (const Benchmark& benchmark : benchmarks()) {
    nlohmann::json meshes = nlohmann::json::array();
    for (const BenchmarkMesh& mesh : benchmark.meshes) {
      meshes.push_back({{"object", mesh.object}, {"file", mesh.file}, {"md5", mesh.md5}, {"from", mesh.from}});
    }
    all.push_back({{"name", benchmark.name},
                   {"version", benchmark.version},
                   {"text", benchmark.text},
                   {"meshes", std::move(meshes)},
                   {"stand_ins", benchmark.stand_ins}});
  }
  return {{"benchmarks", std::move(all)}};
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
    options
        .value("--meshes", meshes_, "LIST",
               "any other meshes instead of the protocol's, files and folders of them, separated by commas; their "
               "figures stand beside one another alone")
        .excludes("--objects");
    add_mesh_options(options.group(), compare_.mesh);
    options.value("--strategies", compare_.strategy_list, "LIST",
                  "strategies instead of the protocol's, separated by commas; the first is set beside published "
                  "figures. surface-one-shot chooses all views at once");
    options.value(
        "--only", only_, "LIST",
        "objects instead of all of the protocol's, separated by commas; OBJECT@VIEW is one of its first views, as "
        "--list shows them");
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
    for (const char* option : {"--mesh-scale", "--mesh-up"}) {
      if (meshes_.empty() && command_->count(option) > 0) usage_error(option, "goes with --meshes");
    }
    if (!only_.empty()) wanted_ = list_parts("--only", only_);
    require_ok(compare_.mesh.validate(), "--mesh-scale");
    if (!meshes_.empty()) own_meshes_ = named_meshes(meshes_);
    if (!wanted_.empty()) check_wanted(wanted_, benchmark_, object_names(benchmark_, !objects_.empty(), own_meshes_));
    check_campaign_options(compare_);
    const std::string names =
        compare_.strategy_list.empty() ? joined(benchmark_.strategies, ",") : compare_.strategy_list;
    compare_.strategies = parse_strategies(names, benchmark_planners(global.planners));
    compare_.robot = benchmark_.robot;
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    if (name_.empty()) return Outcome{.result = benchmark_list_json(), .text = benchmark_list()};
    compare_.out = context.out();
    SACCADE_TRY(BenchmarkPlan plan, recorded(context, compare_, plan_of_objects()));
    if (!wanted_.empty()) SACCADE_CHECK(keep_only(plan, benchmark_, wanted_, objects_));
    SACCADE_TRY(const Comparison comparison,
                recorded(context, compare_, Comparison::create(options_for(plan), plan.scenes)));
    return run_campaign(context, comparison,
                        [&](const Campaign& campaign, const ComparedRuns& compared, nlohmann::json& result) {
                          return report(context, plan, comparison, campaign, compared, result);
                        });
  }

 private:
  [[nodiscard]] Result<BenchmarkPlan> plan_of_objects() const {
    if (!own_meshes_.empty()) return plan_benchmark(benchmark_, own_meshes_, compare_.mesh);
    return plan_benchmark(benchmark_, objects_.empty() ? std::nullopt : std::optional<std::filesystem::path>{objects_});
  }

  CompareOptions options_for(const BenchmarkPlan& plan) const {
    CompareOptions options = compare_;
    options.run.run = plan.run;
    options.noises = {noise_key(plan.run)};
    options.same_runs_once = true;
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
    const auto planned = result.at("runs").at("planned").get<std::size_t>();
    std::set<std::string> of_one_seed;
    for (const NamedPlanner& strategy : compare_.strategies) {
      if (comparison.is_same_for_all_seeds(strategy, noise_key(plan.run))) of_one_seed.insert(strategy.name);
    }
    const BenchmarkTable table = benchmark_table(benchmark_, plan, measured, compared, of_one_seed, planned);
    SACCADE_CHECK(write_benchmark(context.out(), benchmark_, plan, table, measured));
    result["benchmark"] = benchmark_json(benchmark_, plan, table);
    return benchmark_text(benchmark_, plan, table);
  }

  std::string name_;
  std::string objects_;
  std::string meshes_;
  std::vector<std::filesystem::path> own_meshes_;  ///< what meshes_ names
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
