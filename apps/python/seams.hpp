// SPDX-License-Identifier: Apache-2.0
#pragma once
// Seams of the loop whose body is an object of Python: camera, robot, attention, views, gain, recorder, stopping.
// Each is a function, or an object with a method of the seam's name. docs/guides/python.md.

#include <memory>
#include <string>

#include "convert.hpp"
#include "map.hpp"
#include "saccade/explore/planners.hpp"
#include "saccade/explore/recorder.hpp"
#include "saccade/explore/stopping.hpp"
#include "saccade/robot/robot.hpp"

namespace saccade::python {

/// An object of Python that C++ keeps, and lets go from any thread.
class Kept {
 public:
  explicit Kept(py::object object) : object_{std::move(object)} {}
  Kept(const Kept&) = delete;
  Kept& operator=(const Kept&) = delete;
  ~Kept() {
    const py::gil_scoped_acquire gil;
    object_ = py::object{};
  }
  [[nodiscard]] const py::object& get() const { return object_; }

 private:
  py::object object_;
};

/// The object's method of that name, or the object itself where it can be called. TypeError for any other.
[[nodiscard]] py::object body_of(const py::object& object, const char* method);

/// What attention, views and gain may look at.
struct SeamContext {
  std::shared_ptr<SharedMap> map;
  std::optional<Region> region;  ///< nullopt: attention is still to say
  PinholeCamera sensor;
  std::size_t views_taken{0};
};

/// A base strategy by its name, with parts of the caller's in place of its own.
struct Strategy {
  std::string base{"sphere"};
  std::string name;
  py::object attention, views, gain;
  std::optional<double> min_gain;
  std::string gain_unit{"gain"};
};

/// A strategy's name, or a Strategy, as a planner. ValueError for a name that is not among `planners`.
[[nodiscard]] NamedPlanner planner_of(const py::object& strategy, const Planners& planners);

/// capture(T_world_camera) returns depth, or (depth, color), or (depth, color, T_world_camera).
[[nodiscard]] std::unique_ptr<Camera> camera_of(const py::object& camera);
/// move_to(T_world_camera) returns where the camera is, True for there, None or False where it declines;
/// reachable(T_world_camera), if there is one, a bool for each of N poses. None: a camera that flies.
[[nodiscard]] std::unique_ptr<Robot> robot_of(const py::object& robot);
/// scanned(scan, map), viewed(view, map, frames) and ended(run), each if there is one.
[[nodiscard]] std::unique_ptr<Recorder> recorder_of(const py::object& recorder);
/// A function of the run's record: true ends the run.
[[nodiscard]] std::unique_ptr<Stopping> stopping_of(const py::object& stopping);

}  // namespace saccade::python
