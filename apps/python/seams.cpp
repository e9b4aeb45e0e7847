// SPDX-License-Identifier: Apache-2.0
#include "seams.hpp"

#include <algorithm>

#include "arrays.hpp"
#include "records.hpp"

namespace saccade::python {
namespace {

std::string type_of(const py::object& object) { return py::str(py::type::of(object).attr("__name__")); }

bool has(const py::object& object, const char* method) { return py::hasattr(object, method); }

/// Camera whose frames come from a Python function.
class PythonCamera final : public Camera {
 public:
  PythonCamera(const PinholeCamera& intrinsics, py::object capture)
      : intrinsics_{intrinsics}, capture_{std::move(capture)} {}
  [[nodiscard]] const PinholeCamera& intrinsics() const override { return intrinsics_; }
  [[nodiscard]] Result<Frame> capture(const Pose& T_world_camera) override {
    const py::gil_scoped_acquire gil;
    const py::object said = capture_.get()(from_pose(T_world_camera));
    Frame frame;
    frame.index = frames_++;
    frame.name = "frame " + std::to_string(frame.index);
    const auto parts = py::isinstance<py::tuple>(said) ? said.cast<py::tuple>() : py::make_tuple(said);
    if (parts.empty() || parts.size() > 3) {
      throw py::value_error{"capture must return depth, (depth, color) or (depth, color, T_world_camera)"};
    }
    frame.depth = to_depth(array_of(parts[0], "depth"));
    if (parts.size() > 1 && !parts[1].is_none()) frame.color = to_color(array_of(parts[1], "color"));
    if (parts.size() > 2 && !parts[2].is_none()) frame.T_world_camera = to_pose(array_of(parts[2], "T_world_camera"));
    if (frame.depth.width() != intrinsics_.width || frame.depth.height() != intrinsics_.height) {
      return Error{Errc::size_mismatch,
                   "capture returned " + std::to_string(frame.depth.height()) + " x " +
                       std::to_string(frame.depth.width()) + " pixels, the camera has " +
                       std::to_string(intrinsics_.height) + " x " + std::to_string(intrinsics_.width),
                   {}};
    }
    return frame;
  }

 private:
  static py::array array_of(const py::object& object, const char* what) {
    const py::array array = py::array::ensure(object);
    if (!array) {
      PyErr_Clear();
      throw py::type_error{std::string{what} + " must be an array, not " + type_of(object)};
    }
    return array;
  }
  PinholeCamera intrinsics_;
  Kept capture_;
  std::size_t frames_{0};
};

/// Robot that plans its own motions.
class PythonRobot final : public Robot {
 public:
  explicit PythonRobot(const py::object& robot)
      : move_to_{body_of(robot, "move_to")},
        reachable_{has(robot, "reachable") ? py::object{robot.attr("reachable")} : py::none()} {}

  [[nodiscard]] std::vector<std::optional<Refusal>> test(std::span<const Pose> poses, const Executor&) const override {
    std::vector<std::optional<Refusal>> refusals(poses.size());
    const py::gil_scoped_acquire gil;
    if (reachable_.get().is_none()) return refusals;
    const py::object said = reachable_.get()(from_poses(poses));
    const auto values = py::array_t<bool, py::array::forcecast>::ensure(said);
    if (!values || values.ndim() != 1 || values.shape(0) != static_cast<py::ssize_t>(poses.size())) {
      PyErr_Clear();
      throw py::value_error{"reachable must return one bool for each of the " + std::to_string(poses.size()) +
                            " poses"};
    }
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (!values.at(static_cast<py::ssize_t>(i))) refusals[i] = Refusal::declined;
    }
    return refusals;
  }
  [[nodiscard]] Result<PlannedMotion> plan(std::span<const Pose> T_world_camera, MotionKind) override {
    return PlannedMotion{Motion{0, T_world_camera.front(), {}, 0.0}, {}, {}};
  }
  [[nodiscard]] Result<std::optional<Arrival>> execute(const Motion& motion, const MotionObserver&) override {
    const py::gil_scoped_acquire gil;
    const py::object said = move_to_.get()(from_pose(motion.T_world_camera));
    if (said.is_none()) return std::optional<Arrival>{};
    if (py::isinstance<py::bool_>(said)) {
      return said.cast<bool>() ? std::optional{Arrival{motion.T_world_camera, 0.0, false}} : std::nullopt;
    }
    const py::array pose = py::array::ensure(said);
    if (!pose) {
      PyErr_Clear();
      throw py::type_error{"move_to must return a pose, True, False or None, not " + type_of(said)};
    }
    return std::optional{Arrival{to_pose(pose), 0.0, false}};
  }

 private:
  Kept move_to_, reachable_;
};

class PythonRecorder final : public Recorder {
 public:
  explicit PythonRecorder(py::object recorder) : recorder_{std::move(recorder)} {}
  [[nodiscard]] Status scanned(ScanRecord& scan, const TsdfSnapshot& map) override {
    return call("scanned", [&](const py::object& body) { body(to_dict(scan), SharedMap{TsdfMap{map}, 0}); });
  }
  [[nodiscard]] Status viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> frames) override {
    return call("viewed", [&](const py::object& body) {
      py::list images;
      for (const Frame& frame : frames) images.append(from_depth(frame.depth));
      body(to_dict(view), SharedMap{TsdfMap{map}, 0}, images);
    });
  }
  [[nodiscard]] Status ended(const RunRecord& run) override {
    return call("ended", [&](const py::object& body) { body(to_dict(run)); });
  }

 private:
  template <class Body>
  Status call(const char* method, const Body& body) const {
    const py::gil_scoped_acquire gil;
    if (has(recorder_.get(), method)) body(recorder_.get().attr(method));
    return {};
  }
  Kept recorder_;
};

class PythonStopping final : public Stopping {
 public:
  explicit PythonStopping(py::object stopping) : stopping_{std::move(stopping)} {}
  [[nodiscard]] std::optional<StopReason> reached(const RunRecord& run) const override {
    const py::gil_scoped_acquire gil;
    return py::bool_(stopping_.get()(to_dict(run))) ? std::optional{StopReason::cancelled} : std::nullopt;
  }

 private:
  Kept stopping_;
};

}  // namespace

py::object body_of(const py::object& object, const char* method) {
  if (has(object, method)) return object.attr(method);
  if (PyCallable_Check(object.ptr()) != 0) return object;
  throw py::type_error{type_of(object) + " is no function, and has no method " + method};
}

std::unique_ptr<Camera> camera_of(const py::object& camera) {
  if (!has(camera, "intrinsics") || !has(camera, "capture")) {
    throw py::type_error{"a camera needs `intrinsics` (a PinholeCamera) and a method capture(T_world_camera); " +
                         type_of(camera) + " lacks one"};
  }
  if (!py::isinstance<PinholeCamera>(camera.attr("intrinsics"))) {
    throw py::type_error{"a camera's `intrinsics` must be a PinholeCamera"};
  }
  return std::make_unique<PythonCamera>(camera.attr("intrinsics").cast<PinholeCamera>(), camera.attr("capture"));
}

std::unique_ptr<Robot> robot_of(const py::object& robot) {
  if (robot.is_none()) return std::make_unique<FreeRobot>();
  return std::make_unique<PythonRobot>(robot);
}

std::unique_ptr<Recorder> recorder_of(const py::object& recorder) {
  if (recorder.is_none()) return nullptr;
  const auto known = {"scanned", "viewed", "ended"};
  if (std::none_of(known.begin(), known.end(), [&](const char* method) { return has(recorder, method); })) {
    throw py::type_error{"a recorder needs a method scanned, viewed or ended; " + type_of(recorder) + " has none"};
  }
  return std::make_unique<PythonRecorder>(recorder);
}

std::unique_ptr<Stopping> stopping_of(const py::object& stopping) {
  if (stopping.is_none()) return nullptr;
  return std::make_unique<PythonStopping>(body_of(stopping, "reached"));
}

}  // namespace saccade::python
