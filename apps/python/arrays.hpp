// SPDX-License-Identifier: Apache-2.0
#pragma once
// Points, colours and labels from arrays of N rows, and back; words for the values of an enum.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "convert.hpp"
#include "saccade/cloud/point_cloud.hpp"

namespace saccade::python {

/// Converts N numbers. `what` names them in errors.
[[nodiscard]] std::vector<double> to_numbers(const py::object& object, const char* what);
/// Converts N×3 numbers of any stride. `what` names them in errors.
[[nodiscard]] std::vector<Eigen::Vector3d> to_vectors(const py::object& object, const char* what);
/// Works as to_vectors, in single precision: float32 keeps its bits.
[[nodiscard]] std::vector<Eigen::Vector3f> to_vectors_f(const py::object& object, const char* what);
/// Converts N×3 colours, uint8 for [0, 255] or floats in [0, 1].
[[nodiscard]] std::vector<Eigen::Vector3f> to_colors(const py::object& object);
/// Converts N integers as in a file; 0, no label, becomes kUnlabelled.
[[nodiscard]] std::vector<std::uint32_t> to_labels(const py::object& object, const char* what);

/// Returns N×3 float32.
[[nodiscard]] py::array_t<float> from_vectors(std::span<const Eigen::Vector3f> vectors);
/// Returns N×3 float64.
[[nodiscard]] py::array_t<double> from_vectors(std::span<const Eigen::Vector3d> vectors);
/// Returns N×3 uint8 of colours in [0, 1].
[[nodiscard]] py::array_t<std::uint8_t> from_colors(std::span<const Eigen::Vector3f> colors);
/// Returns N uint32; 0: none, otherwise label + 1.
[[nodiscard]] py::array_t<std::uint32_t> from_labels(std::vector<std::uint32_t> labels);
/// Returns H×W float32.
[[nodiscard]] py::array_t<float> from_depth(const DepthImage& depth);
/// Returns H×W×3 uint8.
[[nodiscard]] py::array_t<std::uint8_t> from_color(const ColorImage& color);

/// Makes a cloud of points N×3, relative to its offset_m where they are float64 far from their origin, with normals
/// N×3, colours N×3 and radii N, each None or with one entry per point.
[[nodiscard]] PointCloud to_cloud(const py::object& points, const py::object& normals, const py::object& colors,
                                  const py::object& radii);

/// Returns the value that a word stands for. A ValueError lists the words.
template <class Names>
auto value_of(const Names& names, const std::string& word, const char* what) {
  const auto value = names.find(word);
  if (!value) throw py::value_error{std::string{what} + " must be " + names.listed() + ", not " + word};
  return *value;
}

}  // namespace saccade::python
