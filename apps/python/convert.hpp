// SPDX-License-Identifier: Apache-2.0
#pragma once
// Conversion of values between Saccade and Python: arrays, poses, regions; errors as exceptions; progress.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <exception>
#include <span>
#include <string>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/core/region.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade::python {

namespace py = pybind11;

/// Raises the exception for an error, with its message.
[[noreturn]] void raise(const Error& error);

template <class T>
T take(Result<T> result) {
  if (!result) raise(result.error());
  return std::move(result).value();
}
inline void take(const Status& status) {
  if (!status) raise(status.error());
}

/// Converts H×W of any stride: float32 or float64 metres, uint16 millimetres. 0 or NaN: no return; d < 0: seen free up
/// to |d|.
[[nodiscard]] DepthImage to_depth(const py::array& array);
/// Converts H×W×3 uint8, sRGB.
[[nodiscard]] ColorImage to_color(const py::array& array);
/// Converts 4×4 or 3×4, camera → world.
[[nodiscard]] Pose to_pose(const py::array& array);
/// Converts N×4×4 or N×3×4, or a sequence of poses.
[[nodiscard]] std::vector<Pose> to_poses(const py::object& poses);
/// Returns 4×4 float64.
[[nodiscard]] py::array_t<double> from_pose(const Pose& pose);
/// Returns N×4×4 float64.
[[nodiscard]] py::array_t<double> from_poses(std::span<const Pose> poses);
/// Converts a Box, Sphere or Cylinder, or a pair of corners.
[[nodiscard]] Region to_region(const py::object& object);
[[nodiscard]] Box to_box(const py::object& object);
[[nodiscard]] Eigen::Vector3d to_point(const py::object& object);
[[nodiscard]] py::array_t<double> from_point(const Eigen::Vector3d& point);

/// Returns an array that owns the vector's memory, without a copy. The product of `shape` must be the vector's length.
template <class T>
py::array_t<T> adopt(std::vector<T>&& values, const std::vector<py::ssize_t>& shape) {
  auto* kept = new std::vector<T>{std::move(values)};
  const py::capsule owner{kept, [](void* p) { delete static_cast<std::vector<T>*>(p); }};
  return py::array_t<T>{shape, kept->data(), owner};
}

/// Reports progress to a Python function, and ends the work on Ctrl-C or when that function raises.
class CallerProgress {
 public:
  /// @param callback  called with stage, done, total; may be None
  explicit CallerProgress(py::object callback);
  [[nodiscard]] const Progress& progress() const { return progress_; }
  /// Raises the callback's exception, or KeyboardInterrupt. Call it after the work, holding the GIL.
  void rethrow();

 private:
  void report(std::string_view stage, std::size_t done, std::size_t total);

  py::object callback_;
  Progress progress_;
  std::exception_ptr raised_;
};

void bind_sensor(py::module_& module);
void bind_map(py::module_& module);
void bind_views(py::module_& module);
void bind_strategy(py::module_& module);
void bind_arm(py::module_& module);
void bind_explore(py::module_& module);
void bind_trial(py::module_& module);
void bind_hands(py::module_& module);
void bind_frames(py::module_& module);
void bind_clouds(py::module_& module);
void bind_tracking(py::module_& module);
void bind_segments(py::module_& module);
void bind_filter(py::module_& module);
void bind_surfels(py::module_& module);
void bind_annotation(py::module_& module);

}  // namespace saccade::python
