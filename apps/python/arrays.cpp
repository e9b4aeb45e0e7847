// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/io/clouds/cloud_io.hpp"

namespace saccade::python {
namespace {

std::string form_of(const py::array& array) { return py::str(array.attr("shape")); }

/// Returns an array of numbers; raises TypeError for other types.
py::array numbers_of(const py::object& object, const char* what) {
  const py::array array = py::array::ensure(object);
  if (!array) {
    PyErr_Clear();
    throw py::type_error{std::string{what} + " must be an array, not " + std::string{py::str(py::type::of(object))}};
  }
  const char kind = array.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u') {
    throw py::type_error{std::string{what} + " must be of numbers, not " + std::string{py::str(array.dtype())}};
  }
  return array;
}

template <class T>
std::vector<Eigen::Matrix<T, 3, 1>> rows_of(const py::object& object, const char* what) {
  const py::array array = numbers_of(object, what);
  if (array.size() == 0) return {};
  if (array.ndim() != 2 || array.shape(1) != 3) {
    throw py::value_error{std::string{what} + " must be N x 3, not of shape " + form_of(array)};
  }
  const auto values = py::array_t<T, py::array::forcecast>{array};
  const auto rows = values.template unchecked<2>();
  std::vector<Eigen::Matrix<T, 3, 1>> vectors(static_cast<std::size_t>(rows.shape(0)));
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
    vectors[static_cast<std::size_t>(i)] = {rows(i, 0), rows(i, 1), rows(i, 2)};
  }
  return vectors;
}

template <class T>
py::array_t<T> array_of(std::span<const Eigen::Matrix<T, 3, 1>> vectors) {
  std::vector<T> values;
  values.reserve(vectors.size() * 3);
  for (const auto& vector : vectors) values.insert(values.end(), {vector.x(), vector.y(), vector.z()});
  return adopt(std::move(values), {static_cast<py::ssize_t>(vectors.size()), 3});
}

}  // namespace

std::vector<double> to_numbers(const py::object& object, const char* what) {
  const py::array array = numbers_of(object, what);
  if (array.ndim() != 1) throw py::value_error{std::string{what} + " must be N, not of shape " + form_of(array)};
  const auto values = py::array_t<double, py::array::forcecast>{array};
  const auto row = values.unchecked<1>();
  std::vector<double> numbers(static_cast<std::size_t>(row.shape(0)));
  for (py::ssize_t i = 0; i < row.shape(0); ++i) numbers[static_cast<std::size_t>(i)] = row(i);
  return numbers;
}

std::vector<Eigen::Vector3d> to_vectors(const py::object& object, const char* what) {
  return rows_of<double>(object, what);
}

std::vector<Eigen::Vector3f> to_vectors_f(const py::object& object, const char* what) {
  return rows_of<float>(object, what);
}

std::vector<Eigen::Vector3f> to_colors(const py::object& object) {
  const py::array array = numbers_of(object, "colors");
  const bool bytes = array.dtype().is(py::dtype::of<std::uint8_t>());
  if (!bytes && array.dtype().kind() != 'f') {
    throw py::type_error{"colors must be uint8, or floats in [0, 1], not " + std::string{py::str(array.dtype())}};
  }
  std::vector<Eigen::Vector3f> colors = to_vectors_f(array, "colors");
  for (Eigen::Vector3f& color : colors) {
    if (bytes) color = color.unaryExpr([](float channel) { return channel / 255.0F; });
    if (!(color.minCoeff() >= 0.0F && color.maxCoeff() <= 1.0F && color.allFinite())) {
      throw py::value_error{"colors that are floats must lie in [0, 1]"};
    }
  }
  return colors;
}

std::vector<std::uint32_t> to_labels(const py::object& object, const char* what) {
  const py::array array = numbers_of(object, what);
  if (array.dtype().kind() == 'f') {
    throw py::type_error{std::string{what} + " must be whole numbers, not " + std::string{py::str(array.dtype())}};
  }
  if (array.ndim() != 1) throw py::value_error{std::string{what} + " must be N, not of shape " + form_of(array)};
  const auto values = py::array_t<std::int64_t, py::array::forcecast>{array};
  const auto row = values.unchecked<1>();
  std::vector<std::uint32_t> labels(static_cast<std::size_t>(row.shape(0)));
  for (py::ssize_t i = 0; i < row.shape(0); ++i) {
    const std::int64_t number = row(i);
    if (number < 0 || number >= std::int64_t{kUnlabelled}) {
      throw py::value_error{std::string{what} + " must lie in [0, 2^32 - 1), not be " + std::to_string(number)};
    }
    labels[static_cast<std::size_t>(i)] = number == 0 ? kUnlabelled : static_cast<std::uint32_t>(number);
  }
  return labels;
}

py::array_t<float> from_vectors(std::span<const Eigen::Vector3f> vectors) { return array_of<float>(vectors); }
py::array_t<double> from_vectors(std::span<const Eigen::Vector3d> vectors) { return array_of<double>(vectors); }

py::array_t<std::uint8_t> from_colors(std::span<const Eigen::Vector3f> colors) {
  std::vector<std::uint8_t> values;
  values.reserve(colors.size() * 3);
  for (const Eigen::Vector3f& color : colors) {
    for (const int channel : {0, 1, 2}) {
      values.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(color[channel], 0.0F, 1.0F) * 255.0F)));
    }
  }
  return adopt(std::move(values), {static_cast<py::ssize_t>(colors.size()), 3});
}

py::array_t<std::uint32_t> from_labels(std::vector<std::uint32_t> labels) {
  for (std::uint32_t& label : labels) label = label == kUnlabelled ? 0 : label + 1;
  const auto count = static_cast<py::ssize_t>(labels.size());
  return adopt(std::move(labels), {count});
}

py::array_t<float> from_depth(const DepthImage& depth) {
  std::vector<float> values{depth.pixels()};
  return adopt(std::move(values), {depth.height(), depth.width()});
}

py::array_t<std::uint8_t> from_color(const ColorImage& color) {
  std::vector<std::uint8_t> values;
  values.reserve(color.size() * 3);
  for (const Rgb8& pixel : color.pixels()) values.insert(values.end(), pixel.begin(), pixel.end());
  return adopt(std::move(values), {color.height(), color.width(), 3});
}

namespace {

/// Sets the cloud's points; of doubles, relative to an offset where they lie far from their origin.
void set_points(const py::object& points, PointCloud& cloud) {
  if (!py::isinstance<py::array>(points) || !py::array{points}.dtype().is(py::dtype::of<double>())) {
    cloud.positions_m = to_vectors_f(points, "points");
    return;
  }
  const std::vector<Eigen::Vector3d> exact_m = to_vectors(points, "points");
  ColumnTable fields;
  for (const auto& [axis, name] : {std::pair{0, "x"}, {1, "y"}, {2, "z"}}) {
    std::vector<double> values;
    values.reserve(exact_m.size());
    for (const Eigen::Vector3d& p : exact_m) values.push_back(p[axis]);
    fields.add<double>(name, std::move(values));
  }
  PointCloud placed = take(cloud_from_fields(fields));
  cloud.positions_m = std::move(placed.positions_m);
  cloud.offset_m = placed.offset_m;
}

}  // namespace

PointCloud to_cloud(const py::object& points, const py::object& normals, const py::object& colors,
                    const py::object& radii) {
  PointCloud cloud;
  set_points(points, cloud);
  if (!normals.is_none()) cloud.normals = to_vectors_f(normals, "normals");
  if (!colors.is_none()) cloud.colors = to_colors(colors);
  if (!radii.is_none()) {
    for (const double radius_m : to_numbers(radii, "radii")) cloud.radii_m.push_back(static_cast<float>(radius_m));
  }
  const auto expect_each = [&](const py::object& given, std::size_t count, const char* what) {
    if (given.is_none() || count == cloud.positions_m.size()) return;
    throw py::value_error{"there are " + std::to_string(cloud.positions_m.size()) + " points, but " +
                          std::to_string(count) + " " + what};
  };
  expect_each(normals, cloud.normals.size(), "normals");
  expect_each(colors, cloud.colors.size(), "colors");
  expect_each(radii, cloud.radii_m.size(), "radii");
  take(cloud.validate());
  return cloud;
}

}  // namespace saccade::python
