// SPDX-License-Identifier: Apache-2.0
#pragma once
// Seams of the loop implemented by Python objects: camera, robot, attention, views, gain, recorder, stopping. Each is a
// function, or an object with a method of the seam's name. docs/guides/python.md.

#include <memory>
#include <string>

#include "convert.hpp"
#include "map.hpp"
#include "saccade/explore/planners.hpp"
#include "saccade/explore/recorder.hpp"
#include "saccade/explore/stopping.hpp"
#include "saccade/robot/robot.hpp"

namespace saccade::python {

/// Python object held by C++, which any thread may release.
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

/// Returns the object's method of that name, or the object itself if it is callable. Raises TypeError for others.
[[nodiscard]] py::object body_of(const py::object& object, const char* method);

/// Input of attention, views and gain.
struct SeamContext {
  std::shared_ptr<SharedMap> map;
  std::optional<Region> region;  ///< nullopt: attention has not chosen yet
  PinholeCamera sensor;
  std::size_t views_taken{0};
};

/// Base strategy by name, with some parts replaced by the caller's.
struct Strategy {
  std::string base{"sphere"};
  std::string name;
  py::object attention, views, gain;
  std::optional<double> min_gain;
  std::string gain_unit{"gain"};
};

/// Converts a strategy's name, or a Strategy, to a planner. Raises ValueError for a name that is not among `planners`.
[[nodiscard]] NamedPlanner planner_of(const py::object& strategy, const Planners& planners);

/// Wraps a camera: capture(T_world_camera) returns depth, or (depth, color), or (depth, color, T_world_camera).
[[nodiscard]] std::unique_ptr<Camera> camera_of(const py::object& camera);
/// Wraps a robot: move_to(T_world_camera) returns the camera's pose, True for the requested one, None or False where it
/// declines; reachable(T_world_camera), if present, a bool for each of N poses. None: a flying camera.
[[nodiscard]] std::unique_ptr<Robot> robot_of(const py::object& robot);
/// Wraps a recorder: scanned(scan, map), viewed(view, map, frames) and ended(run), each if present.
[[nodiscard]] std::unique_ptr<Recorder> recorder_of(const py::object& recorder);
/// Wraps a function of the run's record: true ends the run.
[[nodiscard]] std::unique_ptr<Stopping> stopping_of(const py::object& stopping);

}  // namespace saccade::python
