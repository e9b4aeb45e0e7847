// SPDX-License-Identifier: Apache-2.0
// Point clouds in files.
#include <array>
#include <filesystem>

#include "arrays.hpp"
#include "convert.hpp"
#include "saccade/io/clouds/cloud_io.hpp"

namespace saccade::python {
namespace {

py::dict read_cloud_arrays(const std::string& path) {
  struct Arrays {
    PointCloud cloud;
    std::optional<std::vector<std::uint32_t>> labels;
  };
  const auto read = [&]() -> Result<Arrays> {
    const py::gil_scoped_release released;
    Arrays arrays;
    SACCADE_TRY(const CloudFile file, read_cloud(path));
    auto cloud = cloud_from_fields(file.fields());
    if (!cloud) return Error{cloud.error().code, cloud.error().message, path};
    arrays.cloud = std::move(*cloud);
    if (file.fields().find(kLabelField) == nullptr) return arrays;
    auto labels = labels_from_fields(file.fields());
    if (!labels) return Error{labels.error().code, labels.error().message, path};
    for (std::uint32_t& label : *labels) label = label == kUnlabelled ? 0 : label;
    arrays.labels = std::move(*labels);
    return arrays;
  };
  Arrays arrays = take(read());
  const auto count = static_cast<py::ssize_t>(arrays.cloud.positions_m.size());
  py::dict result;
  result["points"] = from_vectors(arrays.cloud.positions_m);
  const Eigen::Vector3d& offset_m = arrays.cloud.offset_m;
  result["offset"] = adopt(std::vector<double>{offset_m.x(), offset_m.y(), offset_m.z()}, {3});
  for (const char* name : {"normals", "colors", "radii", "labels"}) result[name] = py::none();
  if (!arrays.cloud.normals.empty()) result["normals"] = from_vectors(arrays.cloud.normals);
  if (!arrays.cloud.colors.empty()) result["colors"] = from_colors(arrays.cloud.colors);
  if (!arrays.cloud.radii_m.empty()) result["radii"] = adopt(std::move(arrays.cloud.radii_m), {count});
  if (arrays.labels) result["labels"] = adopt(std::move(*arrays.labels), {count});
  return result;
}

/// Adds three columns; doubles where there is an offset to add.
void add_columns(ColumnTable& table, const std::array<const char*, 3>& names,
                 const std::vector<Eigen::Vector3f>& vectors, const Eigen::Vector3d& offset = Eigen::Vector3d::Zero()) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!offset.isZero(0.0)) {
      std::vector<double> sums;
      sums.reserve(vectors.size());
      for (const Eigen::Vector3f& vector : vectors) sums.push_back(static_cast<double>(vector[axis]) + offset[axis]);
      table.add<double>(names[static_cast<std::size_t>(axis)], sums);
      continue;
    }
    std::vector<float> values;
    values.reserve(vectors.size());
    for (const Eigen::Vector3f& vector : vectors) values.push_back(vector[axis]);
    table.add<float>(names[static_cast<std::size_t>(axis)], values);
  }
}

/// Adds colours: PLY has a property per channel; PCD and text pack them as PCL does.
void add_color_columns(ColumnTable& table, const std::vector<Eigen::Vector3f>& colors, bool is_ply) {
  std::array<std::vector<std::uint8_t>, 3> channels;
  std::vector<std::uint32_t> packed;
  for (const Eigen::Vector3f& color : colors) {
    std::uint32_t all{0};
    for (int k = 0; k < 3; ++k) {
      const auto value = static_cast<std::uint8_t>(std::lround(color[k] * 255.0F));
      channels[static_cast<std::size_t>(k)].push_back(value);
      all = all << 8U | value;
    }
    packed.push_back(all);
  }
  if (!is_ply) return table.add<std::uint32_t>("rgba", packed);
  table.add<std::uint8_t>("red", channels[0]);
  table.add<std::uint8_t>("green", channels[1]);
  table.add<std::uint8_t>("blue", channels[2]);
}

void write_cloud_arrays(const std::string& path, const py::object& points, const py::object& normals,
                        const py::object& colors, const py::object& radii, const py::object& labels,
                        const py::object& offset_object) {
  const Eigen::Vector3d offset = to_point(offset_object);
  const PointCloud cloud = to_cloud(points, normals, colors, radii);
  std::vector<std::uint32_t> numbers;
  if (!labels.is_none()) {
    numbers = to_labels(labels, "labels");
    if (numbers.size() != cloud.positions_m.size()) {
      throw py::value_error{"there are " + std::to_string(cloud.positions_m.size()) + " points, but " +
                            std::to_string(numbers.size()) + " labels"};
    }
    for (std::uint32_t& number : numbers) number = number == kUnlabelled ? 0 : number;
  }
  const auto write = [&]() -> Status {
    const py::gil_scoped_release released;
    const bool is_ply = std::filesystem::path{path}.extension() == ".ply";
    PcdFile file;
    add_columns(file.table, {"x", "y", "z"}, cloud.positions_m, offset + cloud.offset_m);
    if (!cloud.normals.empty()) {
      is_ply ? add_columns(file.table, {"nx", "ny", "nz"}, cloud.normals)
             : add_columns(file.table, {"normal_x", "normal_y", "normal_z"}, cloud.normals);
    }
    if (!cloud.colors.empty()) add_color_columns(file.table, cloud.colors, is_ply);
    if (!cloud.radii_m.empty()) file.table.add<float>(std::string{kRadiusField}, cloud.radii_m);
    file.width = file.table.rows;
    CloudFile made{std::move(file)};
    if (!numbers.empty()) add_label_field(made, numbers);
    return write_cloud(path, made);
  };
  take(write());
}

}  // namespace

void bind_clouds(py::module_& module) {
  module.def(
      "read_cloud", &read_cloud_arrays, py::arg("path"),
      "Reads a point cloud: PCD, PLY, LAS, an array of NumPy (.npy), text (.xyz, .txt, .csv, .pts, .asc) or a scan of "
      "KITTI (.bin). Returns a dict: points N x 3 float32, metres; offset 3 float64, to add to points, not zero "
      "for a cloud far from its origin; normals N x 3 float32; colors N x 3 uint8; radii N float32, metres; labels "
      "N uint32, 0: none. None for what the file lacks.");
  module.def(
      "write_cloud", &write_cloud_arrays, py::arg("path"), py::arg("points"), py::kw_only(),
      py::arg("normals") = py::none(), py::arg("colors") = py::none(), py::arg("radii") = py::none(),
      py::arg("labels") = py::none(), py::arg("offset") = py::make_tuple(0.0, 0.0, 0.0),
      "Writes points N x 3, metres: PLY for a name that ends in .ply, text for .xyz, .txt, .csv, .pts or .asc, else "
      "binary PCD. `normals`: N x 3; `colors`: N x 3, uint8 or floats in [0, 1]; `radii`: N metres; `labels`: N "
      "whole numbers, 0: none; `offset`: 3 numbers that are added to the points, as read_cloud gives them.");
}

}  // namespace saccade::python
