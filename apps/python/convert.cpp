// SPDX-License-Identifier: Apache-2.0
#include "convert.hpp"

#include <cstring>

namespace saccade::python {
namespace {

std::string shape_of(const py::array& array) {
  std::string text;
  for (py::ssize_t i = 0; i < array.ndim(); ++i) {
    text += (i == 0 ? "" : " x ") + std::to_string(array.shape(i));
  }
  return array.ndim() == 0 ? "a single value" : text;
}

std::string dtype_of(const py::array& array) { return py::str(array.dtype()); }

/// Copies an array of any stride into pixels, converting each element.
template <class T, class Pixel>
void copy_rows(const py::array& array, Pixel* out, const auto& convert) {
  const auto* row = static_cast<const std::byte*>(array.data());
  const py::ssize_t columns = array.shape(1);
  const py::ssize_t step = array.strides(1);
  for (py::ssize_t v = 0; v < array.shape(0); ++v, row += array.strides(0)) {
    const std::byte* at = row;
    for (py::ssize_t u = 0; u < columns; ++u, at += step) {
      T value;
      std::memcpy(&value, at, sizeof(T));  // arrays of any stride may lie at any address
      *out++ = convert(value);
    }
  }
}

void expect_image(const py::array& array, const char* what) {
  if (array.ndim() != 2) throw py::value_error{std::string{what} + " must be H x W, not " + shape_of(array)};
  if (array.size() == 0) throw py::value_error{std::string{what} + " is empty: " + shape_of(array)};
}

Eigen::Matrix4d matrix_of(const py::array& array) {
  if (array.ndim() != 2 || (array.shape(0) != 4 && array.shape(0) != 3) || array.shape(1) != 4) {
    throw py::value_error{"a pose must be 4 x 4 or 3 x 4, not " + shape_of(array)};
  }
  if (!py::isinstance<py::array_t<double>>(array) && array.dtype().kind() != 'f' && array.dtype().kind() != 'i') {
    throw py::type_error{"a pose must be of floats, not " + dtype_of(array)};
  }
  const auto values = py::array_t<double, py::array::forcecast>{array};
  const auto m = values.unchecked<2>();
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  for (py::ssize_t row = 0; row < m.shape(0); ++row) {
    for (py::ssize_t column = 0; column < 4; ++column) matrix(row, column) = m(row, column);
  }
  return matrix;
}

}  // namespace

void raise(const Error& error) {
  const std::string text = error.to_string();
  PyObject* type = PyExc_RuntimeError;
  switch (error.code) {
    case Errc::invalid_argument:
    case Errc::size_mismatch:
    case Errc::corrupt_data: type = PyExc_ValueError; break;
    case Errc::not_found: type = PyExc_FileNotFoundError; break;
    case Errc::io_failure: type = PyExc_OSError; break;
    case Errc::unsupported: type = PyExc_NotImplementedError; break;
    case Errc::cancelled: type = PyExc_KeyboardInterrupt; break;
    default: break;
  }
  PyErr_SetString(type, text.c_str());
  throw py::error_already_set{};
}

DepthImage to_depth(const py::array& array) {
  expect_image(array, "depth");
  DepthImage depth{static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0))};
  const py::dtype type = array.dtype();
  if (type.is(py::dtype::of<float>())) {
    if ((array.flags() & py::array::c_style) != 0) {
      std::memcpy(depth.data(), array.data(), depth.size() * sizeof(float));
    } else {
      copy_rows<float>(array, depth.data(), [](float d) { return d; });
    }
  } else if (type.is(py::dtype::of<double>())) {
    copy_rows<double>(array, depth.data(), [](double d) { return static_cast<float>(d); });
  } else if (type.is(py::dtype::of<std::uint16_t>())) {
    copy_rows<std::uint16_t>(array, depth.data(), [](std::uint16_t d) { return static_cast<float>(d) * 1e-3F; });
  } else {
    throw py::type_error{"depth must be float32 (metres) or uint16 (millimetres), not " + dtype_of(array)};
  }
  return depth;
}

ColorImage to_color(const py::array& array) {
  if (array.ndim() != 3 || array.shape(2) != 3 || array.size() == 0) {
    throw py::value_error{"colour must be H x W x 3, not " + shape_of(array)};
  }
  if (!array.dtype().is(py::dtype::of<std::uint8_t>())) {
    throw py::type_error{"colour must be uint8, not " + dtype_of(array)};
  }
  ColorImage color{static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0))};
  const auto values = array.cast<py::array_t<std::uint8_t>>().unchecked<3>();
  for (int v = 0; v < color.height(); ++v) {
    for (int u = 0; u < color.width(); ++u) color(u, v) = {values(v, u, 0), values(v, u, 1), values(v, u, 2)};
  }
  return color;
}

Pose to_pose(const py::array& array) { return take(pose_from_matrix(matrix_of(array))); }

std::vector<Pose> to_poses(const py::object& poses) {
  std::vector<Pose> result;
  for (const py::handle pose : poses) result.push_back(to_pose(py::array::ensure(pose)));
  return result;
}

py::array_t<double> from_pose(const Pose& pose) {
  py::array_t<double> array{{4, 4}};
  auto values = array.mutable_unchecked<2>();
  for (py::ssize_t row = 0; row < 4; ++row) {
    for (py::ssize_t column = 0; column < 4; ++column) values(row, column) = pose.matrix()(row, column);
  }
  return array;
}

py::array_t<double> from_poses(std::span<const Pose> poses) {
  std::vector<double> values;
  values.reserve(poses.size() * 16);
  for (const Pose& pose : poses) {
    for (Eigen::Index row = 0; row < 4; ++row) {
      for (Eigen::Index column = 0; column < 4; ++column) values.push_back(pose.matrix()(row, column));
    }
  }
  const auto count = static_cast<py::ssize_t>(poses.size());
  return adopt(std::move(values), {count, 4, 4});
}

Eigen::Vector3d to_point(const py::object& object) {
  const auto array = py::array_t<double, py::array::forcecast>::ensure(object);
  if (!array || array.ndim() != 1 || array.shape(0) != 3) {
    PyErr_Clear();
    throw py::value_error{"a point must be three numbers, not " + std::string{py::str(object)}};
  }
  return {array.at(0), array.at(1), array.at(2)};
}

py::array_t<double> from_point(const Eigen::Vector3d& point) {
  return adopt(std::vector<double>{point.x(), point.y(), point.z()}, {3});
}

Box to_box(const py::object& object) {
  if (py::isinstance<Box>(object)) return object.cast<Box>();
  if (!py::isinstance<py::sequence>(object) || py::len(object) != 2) {
    throw py::value_error{"a box must be two corners, ((x0, y0, z0), (x1, y1, z1)), not " +
                          std::string{py::str(object)}};
  }
  const auto corners = object.cast<py::sequence>();
  return {to_point(corners[0]), to_point(corners[1])};
}

Region to_region(const py::object& object) {
  if (py::isinstance<Sphere>(object)) return object.cast<Sphere>();
  if (py::isinstance<Cylinder>(object)) return object.cast<Cylinder>();
  return to_box(object);
}

CallerProgress::CallerProgress(py::object callback)
    : callback_{std::move(callback)}, progress_{[this](std::string_view stage, std::size_t done, std::size_t total) {
        report(stage, done, total);
      }} {}

void CallerProgress::report(std::string_view stage, std::size_t done, std::size_t total) {
  const py::gil_scoped_acquire gil;
  if (raised_) return;
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set{};
    if (!callback_.is_none()) callback_(std::string{stage}, done, total);
  } catch (...) {
    raised_ = std::current_exception();
    progress_.request_cancel();
  }
}

void CallerProgress::rethrow() {
  if (raised_) std::rethrow_exception(raised_);
  if (PyErr_CheckSignals() != 0) throw py::error_already_set{};
}

}  // namespace saccade::python
