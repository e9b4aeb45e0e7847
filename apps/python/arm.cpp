// SPDX-License-Identifier: Apache-2.0
#include "arm.hpp"

#include <algorithm>

#include "seams.hpp"

namespace saccade::python {
namespace {

py::array_t<double> from_configuration(const Configuration& q) {
  return adopt(std::vector<double>(q.begin(), q.end()), {q.size()});
}

Configuration to_configuration(const py::object& object, Eigen::Index joints, const char* what) {
  const auto values = py::array_t<double, py::array::forcecast>::ensure(object);
  if (!values || values.ndim() != 1 || values.shape(0) != joints) {
    PyErr_Clear();
    throw py::value_error{std::string{what} + " must be " + std::to_string(joints) + " numbers, one per joint"};
  }
  Configuration q{joints};
  for (Eigen::Index i = 0; i < joints; ++i) q[i] = values.at(i);
  if (!q.allFinite()) throw py::value_error{std::string{what} + " has a joint that is not finite"};
  return q;
}

/// Joints that a Python object moves. It receives the trajectory at even times, and reports positions during the
/// motion.
class PythonJoints final : public JointController {
 public:
  PythonJoints(const py::object& joints, Eigen::Index count)
      : position_{py::object{joints.attr("position")}}, execute_{py::object{joints.attr("execute")}}, count_{count} {}

  [[nodiscard]] Result<Configuration> position() override {
    const py::gil_scoped_acquire gil;
    return to_configuration(position_.get()(), count_, "position()");
  }

  [[nodiscard]] Result<JointArrival> execute(const Trajectory& trajectory, const JointObserver& observer) override {
    const py::gil_scoped_acquire gil;
    if (trajectory.empty()) return JointArrival{to_configuration(position_.get()(), count_, "position()"), false};
    const auto steps = static_cast<std::size_t>(std::ceil(trajectory.duration_s() / SimulatedJoints::kSample_s - 1e-6));
    std::vector<double> times, positions, speeds;
    for (std::size_t i = 0; i <= steps; ++i) {
      const double t_s = std::min(static_cast<double>(i) * SimulatedJoints::kSample_s, trajectory.duration_s());
      const Trajectory::State state = trajectory.at(t_s);
      times.push_back(t_s);
      positions.insert(positions.end(), state.q.begin(), state.q.end());
      speeds.insert(speeds.end(), state.speed.begin(), state.speed.end());
    }
    const auto rows = static_cast<py::ssize_t>(times.size());
    bool stopped = false;
    const auto report = [&](double t_s, const py::object& q) {
      if (!observer) return true;
      const JointSample sample{t_s, to_configuration(q, count_, "report(t_s, q)"), std::nullopt};
      const py::gil_scoped_release released;
      stopped = stopped || observer(sample) == Advance::stop;
      return !stopped;
    };
    const py::object function = py::cpp_function(report, py::arg("t_s"), py::arg("q"));
    execute_.get()(adopt(std::move(times), {rows}), adopt(std::move(positions), {rows, count_}),
                   adopt(std::move(speeds), {rows, count_}), function);
    return JointArrival{to_configuration(position_.get()(), count_, "position()"), stopped};
  }

 private:
  Kept position_, execute_;
  Eigen::Index count_;
};

OwnArm make_arm(const std::string& robot, py::object joints, const py::object& fixtures, const py::object& start,
                const std::string& base, const std::string& tip, const std::string& camera,
                const std::optional<py::array>& T_flange_camera, const std::optional<py::array>& T_world_base) {
  UrdfConfig config;
  config.base = base;
  config.tip = tip;
  config.camera = camera;
  if (T_flange_camera) config.T_flange_camera = to_pose(*T_flange_camera);
  if (T_world_base) config.T_world_base = to_pose(*T_world_base);
  UrdfArm found = take(find_robot(robot, config));
  std::vector<Box> boxes;
  for (const py::handle box : fixtures) boxes.push_back(to_box(py::reinterpret_borrow<py::object>(box)));
  std::optional<Configuration> q;
  const auto count = static_cast<Eigen::Index>(found.arm.joints().size());
  if (!start.is_none()) q = to_configuration(start, count, "start");
  if (!joints.is_none() && (!py::hasattr(joints, "position") || !py::hasattr(joints, "execute"))) {
    throw py::type_error{"joints need the methods position() and execute(t_s, q, dq, report)"};
  }
  return {std::move(found.arm), std::move(found.notes), std::move(boxes), std::move(q), std::move(joints)};
}

}  // namespace

std::unique_ptr<PlannedArm> OwnArm::in(const TsdfConfig& map) const {
  PlannedArmConfig config;
  config.obstacles.fixtures = fixtures;
  config.start = start;
  std::shared_ptr<JointController> controller;
  if (!joints.is_none()) {
    controller = std::make_shared<PythonJoints>(joints, static_cast<Eigen::Index>(model.joints().size()));
  }
  return std::make_unique<PlannedArm>(take(PlannedArm::create(model, map, std::move(config), std::move(controller))));
}

void bind_arm(py::module_& module) {
  py::class_<OwnArm>(module, "Arm",
                     "An arm that plans its way without touching what is known, or not known, to be there; for "
                     "Explorer's `robot`. Its own body is taken out of the camera's frames.")
      .def(py::init(&make_arm), py::arg("robot") = "comau_smart_six", py::kw_only(), py::arg("joints") = py::none(),
           py::arg("fixtures") = py::tuple{}, py::arg("start") = py::none(), py::arg("base") = "", py::arg("tip") = "",
           py::arg("camera") = "", py::arg("T_flange_camera") = py::none(), py::arg("T_world_base") = py::none(),
           "`robot`: a URDF file or a built-in name. `joints`: an object with position() -> q and execute(t_s, q, dq, "
           "report), which follows q (N x joints, radians or metres) at the times t_s (N, seconds), calls report(t, q) "
           "on its way, and stops where that returns False; None: simulated. `fixtures`: solid boxes, world frame. "
           "`start`: q in the beginning. `base`, `tip`, `camera`: links, where the URDF does not say.")
      .def_property_readonly("joint_names",
                             [](const OwnArm& arm) {
                               std::vector<std::string> names;
                               for (const auto& joint : arm.model.joints()) names.push_back(joint.name);
                               return names;
                             })
      .def_readonly("notes", &OwnArm::notes, "What was assumed when the URDF was read.")
      .def(
          "camera_pose",
          [](const OwnArm& arm, const py::object& q) {
            return from_pose(
                camera_pose(arm.model, to_configuration(q, static_cast<Eigen::Index>(arm.model.joints().size()), "q")));
          },
          py::arg("q"), "T_world_camera, 4 x 4, with the joints at q.")
      .def_property_readonly(
          "middle", [](const OwnArm& arm) { return from_configuration(arm.model.middle()); },
          "Each joint in the middle of its range.");
}

}  // namespace saccade::python
