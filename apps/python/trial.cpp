// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/simulated_run.hpp"

#include "convert.hpp"
#include "map.hpp"
#include "saccade/scene/scene_yaml.hpp"

namespace saccade::python {
namespace {

/// What a gain in Python may look at.
struct GainContext {
  std::shared_ptr<SharedMap> map;
  Region region;
  PinholeCamera sensor;
};

/// A gain whose body is a Python function of the poses.
class PythonGain final : public Gain {
 public:
  PythonGain(py::object function, const PinholeCamera& sensor) : function_{std::move(function)}, sensor_{sensor} {}
  PythonGain(const PythonGain&) = delete;
  PythonGain& operator=(const PythonGain&) = delete;
  ~PythonGain() override {
    const py::gil_scoped_acquire gil;
    function_ = py::object{};
  }

  [[nodiscard]] Result<std::vector<double>> evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> T_world_camera) override {
    const py::gil_scoped_acquire gil;
    auto map = std::make_shared<SharedMap>(TsdfMap{context.map}, context.executor.threads());
    const py::object said = function_(GainContext{std::move(map), region.bounds, sensor_}, from_poses(T_world_camera));
    const auto values = py::array_t<double, py::array::forcecast>::ensure(said);
    if (!values || values.ndim() != 1 || values.shape(0) != static_cast<py::ssize_t>(T_world_camera.size())) {
      PyErr_Clear();
      throw py::value_error{"a gain must return one number for each of the " + std::to_string(T_world_camera.size()) +
                            " poses, not " + std::string{py::str(py::type::of(said))}};
    }
    std::vector<double> gains(T_world_camera.size());
    for (std::size_t i = 0; i < gains.size(); ++i) {
      gains[i] = values.at(static_cast<py::ssize_t>(i));
      if (!(std::abs(gains[i]) < 1e300)) {
        throw py::value_error{"gain " + std::to_string(i) + " is no finite number"};
      }
    }
    return gains;
  }

 private:
  py::object function_;
  PinholeCamera sensor_;
};

template <class T>
py::object number_or_none(const std::optional<T>& value) {
  return value ? py::cast(*value) : py::none();
}

py::dict to_dict(const Measures& measures) {
  py::dict result;
  result["coverage"] = number_or_none(measures.coverage);
  result["unknown_left"] = measures.unknown_left;
  result["unknown_near_objects"] = number_or_none(measures.unknown_near_objects);
  result["accuracy_m"] = number_or_none(measures.accuracy_m);
  result["chamfer_m"] = number_or_none(measures.chamfer_m);
  result["f_score"] = number_or_none(measures.f_score);
  return result;
}

py::dict to_dict(const ViewRecord& view) {
  py::dict result = to_dict(view.measures);
  result["region"] = view.region;
  result["T_world_camera"] = from_pose(view.T_world_camera);
  result["gain_predicted"] = view.gain_predicted;
  result["gain_observed"] = view.gain_observed;
  result["candidates"] = view.candidates;
  result["evaluated"] = view.evaluated;
  result["frames"] = view.frames;
  result["path_m"] = view.path_m;
  return result;
}

py::dict to_dict(const RunRecord& run) {
  py::list views;
  for (const ViewRecord& view : run.views) views.append(to_dict(view));
  py::dict result;
  result["scan"] = to_dict(run.scan.measures);
  result["views"] = views;
  result["stopped_because"] = std::string{to_string(run.stopped_because)};
  result["final"] = to_dict(run.final());
  return result;
}

/// A strategy by its name, or that name with a gain of the caller's.
NamedPlanner strategy_of(const std::string& name, const py::object& gain, double min_gain,
                         const PinholeCamera& sensor) {
  NamedPlanner planner = take(trial_planners().find(name));
  if (gain.is_none()) return planner;
  auto shared = std::make_shared<PythonGain>(gain, sensor);
  planner.make = [make = planner.make, shared = std::move(shared)](const PlannerSetup& setup) {
    PlannerParts parts = make(setup);
    parts.gain = shared;
    return parts;
  };
  planner.min_gain = min_gain;
  planner.gain_unit = "gain";
  return planner;
}

py::dict run(const std::string& scene, const std::string& strategy, const py::object& gain, double min_gain,
             int max_views, double voxel_size_m, int width, int gain_width, bool noise, std::uint64_t seed,
             std::size_t threads, py::object progress) {
  SimulatedRunConfig config;
  config.voxel_size_m = voxel_size_m;
  config.camera = config.camera.scaled_to_width(width);
  config.gain_width_px = gain_width;
  config.noise = noise;
  config.seed = seed;
  config.exploration.max_views = max_views;
  config = config.with(strategy_of(strategy, gain, min_gain, config.camera.scaled_to_width(gain_width)));
  const Executor executor = Executor::with_threads(threads);
  CallerProgress told{std::move(progress)};
  const auto explore = [&]() -> Result<RunRecord> {
    const py::gil_scoped_release released;
    SACCADE_TRY(const Scene found, find_scene(scene));
    SACCADE_TRY(const RayScene rays, RayScene::build(found));
    SACCADE_TRY(const Truth truth, Truth::build(rays, kTruthSpacing_m, executor));
    return run_simulated(truth, config, executor, told.progress());
  };
  auto record = explore();
  told.rethrow();
  return to_dict(take(std::move(record)));
}

}  // namespace

void bind_trial(py::module_& module) {
  py::class_<GainContext>(module, "GainContext", "What a gain may look at.")
      .def_property_readonly(
          "map", [](const GainContext& context) { return *context.map; }, "The map so far; a copy that shares memory.")
      .def_property_readonly(
          "region",
          [](const GainContext& context) {
            return std::visit([](const auto& region) { return py::cast(region); }, context.region);
          },
          "Box, Sphere or Cylinder that is looked at.")
      .def_readonly("sensor", &GainContext::sensor, "The virtual camera that views are chosen with.");

  py::module_ trial = module.def_submodule("trial", "Simulated runs whose truth is known.");
  trial.def("scenes", [] {
    std::vector<std::string> names;
    for (const BuiltinScene& scene : builtin_scenes()) names.emplace_back(scene.name);
    return names;
  });
  trial.def("strategies", [] {
    const Planners planners = trial_planners();
    std::vector<std::string> names;
    for (const NamedPlanner& planner : planners.all()) names.push_back(planner.name);
    return names;
  });
  trial.def(
      "run", &run, py::arg("scene"), py::arg("strategy") = "surface", py::kw_only(), py::arg("gain") = py::none(),
      py::arg("min_gain") = 0.0, py::arg("max_views") = 12, py::arg("voxel_size_m") = 0.0058, py::arg("width") = 640,
      py::arg("gain_width") = 160, py::arg("noise") = true, py::arg("seed") = 1, py::arg("threads") = 0,
      py::arg("progress") = py::none(),
      "Explores a scene (a built-in name, clutter:SEED or a YAML file) with a flying camera. `gain(context, poses)` "
      "returns one number for each pose (N x 4 x 4) in place of the strategy's own gain; the run ends where no view "
      "gains more than `min_gain`. Returns a dict: scan, views, final (measures of the map), stopped_because.");
}

}  // namespace saccade::python
