// SPDX-License-Identifier: Apache-2.0
#include "seams.hpp"

namespace saccade::python {
namespace {

SeamContext seam_context(const PlanningContext& context, std::optional<Region> region, const PinholeCamera& sensor) {
  return {std::make_shared<SharedMap>(TsdfMap{context.map}, context.executor.threads()), std::move(region), sensor,
          context.views_taken};
}

class PythonAttention final : public AttentionSource {
 public:
  PythonAttention(std::shared_ptr<Kept> body, const PinholeCamera& sensor) : body_{std::move(body)}, sensor_{sensor} {}
  [[nodiscard]] Result<std::vector<RegionOfInterest>> regions(const PlanningContext& context) override {
    const py::gil_scoped_acquire gil;
    std::vector<RegionOfInterest> found;
    for (const py::handle said : body_->get()(seam_context(context, std::nullopt, sensor_))) {
      RegionOfInterest region;
      region.origin = AttentionOrigin::workspace;
      region.why = "the caller's attention";
      const auto pair = py::reinterpret_borrow<py::object>(said);
      const bool has_saliency =
          py::isinstance<py::tuple>(pair) && py::len(pair) == 2 && PyNumber_Check(pair.cast<py::tuple>()[1].ptr()) != 0;
      region.bounds = to_region(has_saliency ? py::object{pair.cast<py::tuple>()[0]} : pair);
      region.saliency = has_saliency ? pair.cast<py::tuple>()[1].cast<double>() : 1.0;
      if (const Status valid = validate(region.bounds); !valid) raise(valid.error());
      found.push_back(std::move(region));
    }
    std::ranges::stable_sort(found, std::greater{}, &RegionOfInterest::saliency);
    return found;
  }

 private:
  std::shared_ptr<Kept> body_;
  PinholeCamera sensor_;
};

class PythonViews final : public ViewGenerator {
 public:
  PythonViews(std::shared_ptr<Kept> body, const PinholeCamera& sensor) : body_{std::move(body)}, sensor_{sensor} {}
  [[nodiscard]] Result<ViewCandidates> views(const PlanningContext& context, const RegionOfInterest& region) override {
    const py::gil_scoped_acquire gil;
    ViewCandidates found;
    found.T_world_camera = to_poses(body_->get()(seam_context(context, region.bounds, sensor_)));
    return found;
  }

 private:
  std::shared_ptr<Kept> body_;
  PinholeCamera sensor_;
};

class PythonGain final : public Gain {
 public:
  PythonGain(std::shared_ptr<Kept> body, const PinholeCamera& sensor) : body_{std::move(body)}, sensor_{sensor} {}
  [[nodiscard]] Result<std::vector<double>> evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> T_world_camera) override {
    const py::gil_scoped_acquire gil;
    const py::object said = body_->get()(seam_context(context, region.bounds, sensor_), from_poses(T_world_camera));
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
  std::shared_ptr<Kept> body_;
  PinholeCamera sensor_;
};

std::shared_ptr<Kept> kept_body(const py::object& object, const char* method) {
  return object.is_none() ? nullptr : std::make_shared<Kept>(body_of(object, method));
}

}  // namespace

NamedPlanner planner_of(const py::object& said, const Planners& planners) {
  if (py::isinstance<py::str>(said)) return take(planners.find(said.cast<std::string>()));
  if (!py::isinstance<Strategy>(said)) throw py::type_error{"a strategy must be a name or a saccade.Strategy"};
  const auto& strategy = said.cast<const Strategy&>();
  NamedPlanner planner = take(planners.find(strategy.base));
  planner.name = strategy.name;
  planner.text = "a strategy of the caller's";
  if (strategy.min_gain) planner.min_gain = *strategy.min_gain;
  const auto attention = kept_body(strategy.attention, "regions");
  const auto views = kept_body(strategy.views, "views");
  const auto gain = kept_body(strategy.gain, "evaluate");
  if (gain) {
    planner.min_gain = strategy.min_gain.value_or(0.0);
    planner.gain_unit = strategy.gain_unit;
  }
  planner.make = [make = planner.make, attention, views, gain](const PlannerSetup& setup) {
    PlannerParts parts = make(setup);
    if (attention) parts.attention = std::make_shared<PythonAttention>(attention, setup.gain.sensor);
    if (views) parts.generator = std::make_shared<PythonViews>(views, setup.gain.sensor);
    if (gain) parts.gain = std::make_shared<PythonGain>(gain, setup.gain.sensor);
    return parts;
  };
  return planner;
}

void bind_strategy(py::module_& module) {
  py::class_<SeamContext>(module, "PlanningContext", "What attention, views and gains may look at.")
      .def_property_readonly(
          "map", [](const SeamContext& context) { return *context.map; }, "The map so far; a copy that shares memory.")
      .def_property_readonly(
          "region",
          [](const SeamContext& context) -> py::object {
            if (!context.region) return py::none();
            return std::visit([](const auto& region) { return py::cast(region); }, *context.region);
          },
          "Box, Sphere or Cylinder that is looked at; None while attention looks for one.")
      .def_readonly("sensor", &SeamContext::sensor, "The virtual camera that views are chosen with.")
      .def_readonly("views_taken", &SeamContext::views_taken, "Views of the region so far.");

  py::class_<Strategy>(
      module, "Strategy",
      "A strategy by its name, with parts of one's own in place of its attention, its views or its gain. Each is a "
      "function, or an object with the method named here.")
      .def(py::init([](std::string base, py::object attention, py::object views, py::object gain,
                       std::optional<double> min_gain, const std::optional<std::string>& name, std::string gain_unit) {
             static_cast<void>(take(builtin_planners().find(base)));
             if (!attention.is_none()) static_cast<void>(body_of(attention, "regions"));
             if (!views.is_none()) static_cast<void>(body_of(views, "views"));
             if (!gain.is_none()) static_cast<void>(body_of(gain, "evaluate"));
             std::string called = name.value_or(base + "-own");
             return Strategy{std::move(base), std::move(called), std::move(attention), std::move(views),
                             std::move(gain), min_gain,          std::move(gain_unit)};
           }),
           py::arg("base") = "sphere", py::kw_only(), py::arg("attention") = py::none(), py::arg("views") = py::none(),
           py::arg("gain") = py::none(), py::arg("min_gain") = py::none(), py::arg("name") = py::none(),
           py::arg("gain_unit") = "gain",
           "`attention.regions(context)`: regions, or (region, saliency). `views.views(context)`: T_world_camera, "
           "N x 4 x 4. `gain.evaluate(context, T_world_camera)`: N finite numbers, larger is better. `min_gain`: views "
           "that gain less are not worth going to; 0 with a gain of one's own, else the base's.")
      .def_readonly("base", &Strategy::base)
      .def_readonly("name", &Strategy::name)
      .def("__repr__", [](const Strategy& s) { return "Strategy(" + s.base + ", name=" + s.name + ")"; });
}

}  // namespace saccade::python
