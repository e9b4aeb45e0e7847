// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"
#include "records.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/trial/campaign_summary.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "seams.hpp"

namespace saccade::python {
namespace {

/// Scene with known surface.
struct KnownScene {
  Scene scene;
  GroundTruth truth;
};

Result<KnownScene> build_scene(const std::string& name, const Executor& executor) {
  SACCADE_TRY(Scene scene, find_scene(name));
  SACCADE_TRY(const RayScene rays, RayScene::build(scene));
  SACCADE_TRY(GroundTruth truth, GroundTruth::build(rays, kTruthSpacing_m, executor));
  return KnownScene{std::move(scene), std::move(truth)};
}

/// Returns settings shared by runs.
SimulatedRunConfig run_config(int max_views, double voxel_size_m, int width, int gain_width, bool noise) {
  if (width < 1) throw py::value_error{"width must be one pixel at least, not " + std::to_string(width)};
  SimulatedRunConfig config;
  config.voxel_size_m = voxel_size_m;
  config.camera = config.camera.scaled_to_width(width);
  config.gain_width_px = gain_width;
  config.noise = noise;
  config.exploration.max_views = max_views;
  return config;
}

py::dict run(const std::string& scene, const py::object& strategy, const py::object& gain,
             std::optional<double> min_gain, int max_views, double voxel_size_m, int width, int gain_width, bool noise,
             std::uint64_t seed, std::size_t threads, py::object progress) {
  NamedPlanner planner;
  if (gain.is_none()) {
    planner = planner_of(strategy, trial_planners());
    if (min_gain) planner.min_gain = *min_gain;
  } else {
    if (!py::isinstance<py::str>(strategy)) throw py::type_error{"give the gain to the Strategy, or name a strategy"};
    Strategy own;
    own.base = strategy.cast<std::string>();
    own.name = own.base + "-own";
    own.attention = own.views = py::none();
    own.gain = gain;
    own.min_gain = min_gain;
    planner = planner_of(py::cast(std::move(own)), trial_planners());
  }
  SimulatedRunConfig config = run_config(max_views, voxel_size_m, width, gain_width, noise).with(planner);
  config.seed = seed;
  const Executor executor = Executor::with_threads(threads);
  CallerProgress told{std::move(progress)};
  const auto explore = [&]() -> Result<RunRecord> {
    const py::gil_scoped_release released;
    SACCADE_TRY(const KnownScene known, build_scene(scene, executor));
    return run_simulated(known.truth, config, executor, told.progress());
  };
  auto record = explore();
  told.rethrow();
  return to_dict(take(std::move(record)));
}

/// Runs every strategy in every scene with every seed, and summarises the results.
class Comparer {
 public:
  Comparer(std::vector<NamedPlanner> planners, SimulatedRunConfig config, std::size_t threads)
      : planners_{std::move(planners)}, config_{std::move(config)}, executor_{Executor::with_threads(threads)} {}

  void run(const std::vector<std::string>& scenes, const std::vector<std::uint64_t>& seeds, CallerProgress& told) {
    const std::size_t total = scenes.size() * seeds.size() * planners_.size();
    for (const std::string& name : scenes) {
      const auto build = [&] {
        const py::gil_scoped_release released;
        return build_scene(name, executor_);
      };
      const KnownScene known = take(build());
      for (const std::uint64_t seed : seeds) {
        for (const NamedPlanner& planner : planners_) {
          told.progress().report("runs", entries_.size(), total);
          told.rethrow();
          entries_.push_back(one(name, known.truth, planner, seed, told));
        }
      }
    }
    told.progress().report("runs", total, total);
    told.rethrow();
  }

  [[nodiscard]] py::dict result() const {
    const auto budget = static_cast<std::size_t>(config_.exploration.max_views);
    py::list runs;
    for (const CampaignEntry& entry : entries_) {
      py::dict run = to_dict(entry.run);
      run["scene"] = entry.key.scene;
      run["strategy"] = entry.key.strategy;
      run["seed"] = entry.key.seed;
      run["seconds"] = entry.seconds;
      runs.append(run);
    }
    py::list summary;
    py::list gaps;
    const std::vector<CampaignSummary> summaries = summarize(entries_, budget);
    for (const CampaignSummary& one : summaries) {
      summary.append(row_of(one.group, one.figures));
      CampaignGroup first = one.group;
      first.strategy = planners_.front().name;
      if (!(first == one.group)) gaps.append(row_of(one.group, paired_gaps(entries_, one.group, first, budget)));
    }
    py::dict result;
    result["runs"] = runs;
    result["summary"] = summary;
    result["gaps"] = gaps;
    return result;
  }

 private:
  CampaignEntry one(const std::string& scene, const GroundTruth& truth, const NamedPlanner& planner, std::uint64_t seed,
                    CallerProgress& told) const {
    SimulatedRunConfig config = config_.with(planner);
    config.seed = seed;
    const Stopwatch watch;
    Result<RunRecord> record{RunRecord{}};
    {
      const py::gil_scoped_release released;
      record = run_simulated(truth, config, executor_, told.progress());
    }
    told.rethrow();
    CampaignEntry entry;
    entry.key = {scene, {}, planner.name, config.noise ? "kinect-v1" : "none", seed, {}};
    entry.run = take(std::move(record));
    entry.seconds = 1e-3 * watch.elapsed_ms();
    return entry;
  }

  static py::dict row_of(const CampaignGroup& group, const std::vector<MeanEstimate>& figures) {
    py::dict row;
    row["scene"] = number_or_none(group.scene);
    row["strategy"] = group.strategy;
    for (std::size_t i = 0; i < figures.size(); ++i) {
      if (figures[i].n > 0) row[py::str(run_figures()[i].name)] = to_dict(figures[i]);
    }
    return row;
  }

  std::vector<NamedPlanner> planners_;
  SimulatedRunConfig config_;
  Executor executor_;
  std::vector<CampaignEntry> entries_;
};

py::dict compare(const py::sequence& strategies, const std::vector<std::string>& scenes,
                 const std::vector<std::uint64_t>& seeds, int max_views, double voxel_size_m, int width, int gain_width,
                 bool noise, std::size_t threads, py::object progress) {
  std::vector<NamedPlanner> planners;
  for (const py::handle strategy : strategies) {
    planners.push_back(planner_of(py::reinterpret_borrow<py::object>(strategy), trial_planners()));
    for (std::size_t i = 0; i + 1 < planners.size(); ++i) {
      if (planners[i].name == planners.back().name) {
        throw py::value_error{"two strategies are called " + planners[i].name + "; give one another name"};
      }
    }
  }
  if (planners.empty() || scenes.empty() || seeds.empty()) {
    throw py::value_error{"compare needs one strategy, one scene and one seed at least"};
  }
  CallerProgress told{std::move(progress)};
  Comparer comparer{std::move(planners), run_config(max_views, voxel_size_m, width, gain_width, noise), threads};
  comparer.run(scenes, seeds, told);
  return comparer.result();
}

/// Camera in a scene, which also measures maps against the scene's surface.
class SceneCamera {
 public:
  SceneCamera(const std::string& scene, int width, bool noise, std::uint64_t seed, std::size_t threads)
      : executor_{Executor::with_threads(threads)}, known_{build(scene)}, camera_{make(width, noise, seed)} {}

  [[nodiscard]] const PinholeCamera& intrinsics() const { return camera_.camera(); }
  [[nodiscard]] py::array_t<float> capture(const py::array& T_world_camera) {
    const Pose pose = to_pose(T_world_camera);
    const auto look = [&] {
      const py::gil_scoped_release released;
      return camera_.capture(pose, executor_);
    };
    return from_depth(look().depth);
  }
  [[nodiscard]] Box workspace() const { return known_.scene.workspace; }
  [[nodiscard]] py::array_t<double> scan() const { return from_poses(known_.scene.scan); }
  [[nodiscard]] py::dict measure(const SharedMap& map) const {
    const TsdfSnapshot snapshot = map.snapshot();
    Measures measures;
    {
      const py::gil_scoped_release released;
      measures = measure_map(known_.truth, snapshot, executor_);
    }
    return to_dict(measures);
  }

 private:
  [[nodiscard]] KnownScene build(const std::string& scene) const {
    const auto built = [&] {
      const py::gil_scoped_release released;
      return build_scene(scene, executor_);
    };
    return take(built());
  }
  [[nodiscard]] SimulatedCamera make(int width, bool noise, std::uint64_t seed) const {
    SimulatedRunConfig config = run_config(1, SimulatedRunConfig{}.voxel_size_m, width, width, noise);
    config.seed = seed;
    return take(simulated_camera(known_.truth.scene(), config));
  }

  Executor executor_;
  KnownScene known_;
  SimulatedCamera camera_;
};

}  // namespace

void bind_trial(py::module_& module) {
  py::module_ trial = module.def_submodule("trial", "Simulated runs whose truth is known.");
  trial.def(
      "scenes",
      [] {
        std::vector<std::string> names;
        for (const BuiltinScene& scene : builtin_scenes()) names.emplace_back(scene.name);
        return names;
      },
      "Names of the built-in scenes.");
  trial.def(
      "strategies",
      [] {
        const Planners planners = trial_planners();
        std::vector<std::string> names;
        for (const NamedPlanner& planner : planners.all()) names.push_back(planner.name);
        return names;
      },
      "Names of the strategies; `oracle` knows the truth, and runs in trials alone.");
  trial.def(
      "run", &run, py::arg("scene"), py::arg("strategy") = "surface", py::kw_only(), py::arg("gain") = py::none(),
      py::arg("min_gain") = py::none(), py::arg("max_views") = 12, py::arg("voxel_size_m") = 0.0058,
      py::arg("width") = 640, py::arg("gain_width") = 160, py::arg("noise") = true, py::arg("seed") = 1,
      py::arg("threads") = 0, py::arg("progress") = py::none(),
      "Explores a scene (a built-in name, clutter:SEED or a YAML file) with a flying camera. `strategy`: a name, or a "
      "Strategy. `gain(context, poses)` returns one number for each pose (N x 4 x 4) in place of the strategy's own "
      "gain; the run ends where no view gains more than `min_gain`, which is then 0 by default. Returns a dict: scan, "
      "views, final (measures of the map), stopped_because.");
  trial.def(
      "compare", &compare, py::arg("strategies"), py::arg("scenes"), py::arg("seeds"), py::kw_only(),
      py::arg("max_views") = 12, py::arg("voxel_size_m") = 0.0058, py::arg("width") = 640, py::arg("gain_width") = 160,
      py::arg("noise") = true, py::arg("threads") = 0, py::arg("progress") = py::none(),
      "Runs each strategy (a name or a Strategy) in each scene with each seed. Returns a dict: `runs`, as those "
      "of run() with scene, strategy, seed and seconds; `summary`, a row per scene and strategy with the mean of "
      "each figure and its confidence interval (low, high), over all scenes where `scene` is None; `gaps`, the "
      "same for differences from the first strategy in the same scene and seed. Figures: docs/reference/metrics.md.");

  py::class_<SceneCamera>(trial, "SimulatedCamera", "A depth camera in a scene whose surface is known.")
      .def(py::init<const std::string&, int, bool, std::uint64_t, std::size_t>(), py::arg("scene"), py::kw_only(),
           py::arg("width") = 640, py::arg("noise") = true, py::arg("seed") = 1, py::arg("threads") = 0)
      .def_property_readonly("intrinsics", &SceneCamera::intrinsics)
      .def_property_readonly("workspace", &SceneCamera::workspace, "Box that is to be explored.")
      .def_property_readonly("scan", &SceneCamera::scan, "Poses of the scene's initial scan, N x 4 x 4.")
      .def("capture", &SceneCamera::capture, py::arg("T_world_camera"),
           "Depth, H x W float32, metres along z. The n-th frame of a seed is always the same.")
      .def("measure", &SceneCamera::measure, py::arg("map"),
           "What a map is worth beside the scene's surface: coverage, accuracy_m, chamfer_m, f_score, unknown_left.");
}

}  // namespace saccade::python
