// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/cloud_io.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "saccade/io/file_io.hpp"

namespace saccade {

namespace {

using Names = std::array<const char*, 3>;

PlyElement* vertices_of(PlyFile& file) {
  const auto found = std::find_if(file.elements.begin(), file.elements.end(),
                                  [](const PlyElement& element) { return element.name == "vertex"; });
  return found == file.elements.end() ? nullptr : &*found;
}

bool looks_like_pcd(std::string_view text) {
  return text.starts_with("#") || text.starts_with("VERSION") || text.starts_with("FIELDS") ||
         text.starts_with("COLUMNS");
}

/// Three columns with one number per row, or nothing.
std::vector<const Column*> find_three(const ColumnTable& fields, const Names& names) {
  std::vector<const Column*> found;
  for (const char* name : names) {
    const Column* column = fields.find(name);
    if (column != nullptr && column->count == 1) found.push_back(column);
  }
  if (found.size() != names.size()) found.clear();
  return found;
}

std::vector<Eigen::Vector3f> vectors_of(const std::vector<const Column*>& columns, std::size_t rows, double scale) {
  std::vector<Eigen::Vector3f> vectors(rows);
  for (int axis = 0; axis < 3; ++axis) {
    const Column& column = *columns[static_cast<std::size_t>(axis)];
    if (column.type == ColumnType::f32 && scale == 1.0) {
      for (std::size_t i = 0; i < rows; ++i)
        std::memcpy(&vectors[i][axis], &column.bytes[i * sizeof(float)], sizeof(float));
    } else {
      for (std::size_t i = 0; i < rows; ++i) vectors[i][axis] = static_cast<float>(column.value(i) * scale);
    }
  }
  return vectors;
}

/// Whole numbers up to the type's largest stand for [0, 1].
double color_scale(ColumnType type) {
  if (type == ColumnType::f32 || type == ColumnType::f64) return 1.0;
  return 1.0 / (std::pow(2.0, 8.0 * static_cast<double>(bytes_of(type))) - 1.0);
}

/// 0x00RRGGBB in the bits of a float or of a whole number.
std::vector<Eigen::Vector3f> unpacked_colors(const Column& column, std::size_t rows) {
  std::vector<Eigen::Vector3f> colors(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    std::uint32_t packed{0};
    std::memcpy(&packed, &column.bytes[i * sizeof(packed)], sizeof(packed));
    for (const int channel : {0, 1, 2}) {
      colors[i][channel] = static_cast<float>((packed >> (16 - 8 * channel)) & 0xFFU) / 255.0F;
    }
  }
  return colors;
}

std::vector<Eigen::Vector3f> point_colors(const ColumnTable& fields) {
  for (const char* name : {"rgb", "rgba"}) {
    const Column* column = fields.find(name);
    if (column != nullptr && column->count == 1 && bytes_of(column->type) == sizeof(std::uint32_t)) {
      return unpacked_colors(*column, fields.rows);
    }
  }
  const std::vector<const Column*> channels = find_three(fields, {"red", "green", "blue"});
  if (channels.empty()) return {};
  std::vector<Eigen::Vector3f> colors = vectors_of(channels, fields.rows, color_scale(channels[0]->type));
  for (Eigen::Vector3f& color : colors) {
    color = color.allFinite() ? Eigen::Vector3f{color.cwiseMax(0.0F).cwiseMin(1.0F)} : Eigen::Vector3f::Zero();
  }
  return colors;
}

}  // namespace

const ColumnTable& CloudFile::fields() const {
  if (const auto* pcd = std::get_if<PcdFile>(&file)) return pcd->table;
  const PlyElement* vertices = std::get<PlyFile>(file).find("vertex");
  SACCADE_EXPECTS(vertices != nullptr);
  return vertices->table;
}

ColumnTable& CloudFile::fields() {
  if (auto* pcd = std::get_if<PcdFile>(&file)) return pcd->table;
  PlyElement* vertices = vertices_of(std::get<PlyFile>(file));
  SACCADE_EXPECTS(vertices != nullptr);
  return vertices->table;
}

Result<CloudFile> read_cloud(const std::filesystem::path& path) {
  SACCADE_TRY(const std::vector<std::byte> bytes, read_file(path));
  const std::string_view text = as_text(bytes);
  if (text.starts_with("ply")) {
    auto ply = parse_ply(bytes);
    if (!ply) return in_file(ply.error(), path);
    if (vertices_of(*ply) == nullptr) {
      return Error{Errc::corrupt_data, "is a PLY file without vertices", path.string()};
    }
    return CloudFile{std::move(*ply)};
  }
  if (!looks_like_pcd(text)) return Error{Errc::corrupt_data, "is no point cloud in PCD or PLY", path.string()};
  auto pcd = parse_pcd(bytes);
  if (!pcd) return in_file(pcd.error(), path);
  return CloudFile{std::move(*pcd)};
}

Status write_cloud(const std::filesystem::path& path, const CloudFile& cloud) {
  const auto* pcd = std::get_if<PcdFile>(&cloud.file);
  if (path.extension() == ".ply") {
    return pcd != nullptr ? write_ply(path, pcd->table) : write_ply(path, std::get<PlyFile>(cloud.file));
  }
  if (pcd != nullptr) return write_pcd(path, *pcd);
  const PlyElement* vertices = std::get<PlyFile>(cloud.file).find("vertex");
  if (vertices != nullptr && !vertices->lists.empty()) {
    return Error{Errc::unsupported,
                 "a PCD cannot hold the list " + vertices->lists.front().name + " of the points; name a .ply",
                 path.string()};
  }
  return write_pcd(path, cloud.fields());
}

Result<PointCloud> cloud_from_fields(const ColumnTable& fields) {
  const std::vector<const Column*> positions = find_three(fields, {"x", "y", "z"});
  if (positions.empty()) return Error{Errc::corrupt_data, "has no fields x, y and z", {}};
  PointCloud cloud;
  cloud.positions_m = vectors_of(positions, fields.rows, 1.0);
  std::vector<const Column*> normals = find_three(fields, {"normal_x", "normal_y", "normal_z"});
  if (normals.empty()) normals = find_three(fields, {"nx", "ny", "nz"});
  if (!normals.empty()) cloud.normals = vectors_of(normals, fields.rows, 1.0);
  cloud.colors = point_colors(fields);
  return cloud;
}

Result<std::vector<std::uint32_t>> labels_from_fields(const ColumnTable& fields, std::string_view field) {
  const Column* column = fields.find(field);
  if (column == nullptr || column->count != 1) {
    return Error{Errc::not_found, "has no field " + std::string{field}, {}};
  }
  std::vector<std::uint32_t> labels(fields.rows, kUnlabelled);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const double value = column->value(i);
    if (value != std::floor(value) || value > kUnlabelled) {
      return Error{Errc::corrupt_data, "a label that is no whole number below 2^32", "point " + std::to_string(i)};
    }
    if (value > 0.0) labels[i] = static_cast<std::uint32_t>(value);
  }
  return labels;
}

std::string add_labels(CloudFile& cloud, std::span<const std::uint32_t> labels) {
  ColumnTable& fields = cloud.fields();
  SACCADE_EXPECTS(labels.size() == fields.rows);
  std::string kept_as;
  for (Column& column : fields.columns) {
    if (column.name != kLabelField) continue;
    kept_as = "label_input";
    for (int i = 2; fields.find(kept_as) != nullptr; ++i) kept_as = "label_input" + std::to_string(i);
    column.name = kept_as;
  }
  std::vector<std::uint32_t> shown(labels.begin(), labels.end());
  for (std::uint32_t& label : shown) label += 1;  // kUnlabelled becomes 0
  static_assert(kUnlabelled + 1 == 0);
  fields.add<std::uint32_t>(std::string{kLabelField}, shown);
  if (auto* ply = std::get_if<PlyFile>(&cloud.file)) {
    std::vector<int>& order = vertices_of(*ply)->order;
    if (!order.empty()) order.push_back(static_cast<int>(fields.columns.size()) - 1);
  }
  return kept_as;
}

}  // namespace saccade
