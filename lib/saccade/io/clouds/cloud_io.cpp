// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/cloud_io.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <utility>

#include "saccade/io/clouds/internal/kitti_io.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade {

namespace {

namespace fs = std::filesystem;
using Names = std::array<const char*, 3>;

PlyElement* vertices_of(PlyFile& file) {
  const auto found = std::find_if(file.elements.begin(), file.elements.end(),
                                  [](const PlyElement& element) { return element.name == "vertex"; });
  return found == file.elements.end() ? nullptr : &*found;
}

std::string lower_suffix(const fs::path& path) {
  std::string suffix = path.extension().string();
  for (char& c : suffix) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return suffix;
}

enum class Kind { pcd, ply, text, kitti, other };

/// What the first bytes say goes before what the name says; a comment in front may be a PCD's or a text's.
Kind kind_of(const fs::path& path, std::string_view text) {
  if (text.starts_with("ply\n") || text.starts_with("ply\r")) return Kind::ply;
  if (text.starts_with("# .PCD")) return Kind::pcd;
  if (has_text_cloud_suffix(path)) return Kind::text;
  if (lower_suffix(path) == ".bin") return Kind::kitti;
  if (text.starts_with("ply")) return Kind::ply;
  for (const char* begin : {"#", "VERSION", "FIELDS", "COLUMNS"}) {
    if (text.starts_with(begin)) return Kind::pcd;
  }
  return Kind::other;
}

/// Any text may end in .txt or .csv: its beginning decides.
bool is_cloud_file(const fs::path& path) {
  const std::string suffix = lower_suffix(path);
  if (path.filename().string().starts_with(".")) return false;
  if (suffix == ".txt" || suffix == ".csv") {
    constexpr std::size_t kHeadBytes{1 << 16};
    std::string head(kHeadBytes, '\0');
    std::ifstream file{path, std::ios::binary};
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
    return kind_of(path, head) != Kind::text || looks_like_text_cloud(head);
  }
  return suffix == ".pcd" || suffix == ".ply" || suffix == ".bin" || has_text_cloud_suffix(path);
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
  std::vector<const Column*> channels = find_three(fields, {"red", "green", "blue"});
  if (channels.empty()) channels = find_three(fields, {"r", "g", "b"});
  if (channels.empty()) return {};
  std::vector<Eigen::Vector3f> colors = vectors_of(channels, fields.rows, color_scale(channels[0]->type));
  for (Eigen::Vector3f& color : colors) {
    color = color.allFinite() ? Eigen::Vector3f{color.cwiseMax(0.0F).cwiseMin(1.0F)} : Eigen::Vector3f::Zero();
  }
  return colors;
}

/// @return what a field of that name is called now; empty if there was none.
template <class T>
std::string add_field(CloudFile& cloud, std::string_view name, std::string_view earlier, std::span<const T> values) {
  ColumnTable& fields = cloud.fields();
  SACCADE_EXPECTS(values.size() == fields.rows);
  std::string kept_as;
  for (Column& column : fields.columns) {
    if (column.name != name) continue;
    kept_as = fields.unused_name(earlier);
    column.name = kept_as;
  }
  fields.add<T>(std::string{name}, values);
  if (auto* ply = std::get_if<PlyFile>(&cloud.file)) {
    std::vector<int>& order = vertices_of(*ply)->order;
    if (!order.empty()) order.push_back(static_cast<int>(fields.columns.size()) - 1);
  }
  return kept_as;
}

}  // namespace

const ColumnTable& CloudFile::fields() const {
  if (const auto* pcd = std::get_if<PcdFile>(&file)) return pcd->table;
  if (const auto* text = std::get_if<TextCloud>(&file)) return text->table;
  const PlyElement* vertices = std::get<PlyFile>(file).find("vertex");
  SACCADE_EXPECTS(vertices != nullptr);
  return vertices->table;
}

ColumnTable& CloudFile::fields() {
  if (auto* pcd = std::get_if<PcdFile>(&file)) return pcd->table;
  if (auto* text = std::get_if<TextCloud>(&file)) return text->table;
  PlyElement* vertices = vertices_of(std::get<PlyFile>(file));
  SACCADE_EXPECTS(vertices != nullptr);
  return vertices->table;
}

Result<CloudFile> read_cloud(const fs::path& path) {
  SACCADE_TRY(std::vector<std::byte> bytes, read_file(path));
  switch (kind_of(path, as_text(bytes))) {
    case Kind::ply: {
      SACCADE_TRY(PlyFile ply, in_file(parse_ply(bytes), path));
      if (vertices_of(ply) == nullptr) {
        return Error{Errc::corrupt_data, "is a PLY file without vertices", path.string()};
      }
      return CloudFile{std::move(ply)};
    }
    case Kind::pcd: {
      SACCADE_TRY(PcdFile pcd, in_file(parse_pcd(bytes), path));
      return CloudFile{std::move(pcd)};
    }
    case Kind::text: {
      SACCADE_TRY(TextCloud text, in_file(parse_text_cloud(std::move(bytes)), path));
      return CloudFile{std::move(text)};
    }
    case Kind::kitti: {
      SACCADE_TRY(ColumnTable scan, in_file(parse_kitti_scan(bytes), path));
      PcdFile pcd;
      pcd.width = scan.rows;
      pcd.table = std::move(scan);
      return CloudFile{std::move(pcd)};
    }
    case Kind::other: break;
  }
  return Error{Errc::corrupt_data, "is no point cloud in PCD or PLY, nor named .xyz, .txt, .csv, .pts or .bin",
               path.string()};
}

Result<std::vector<fs::path>> list_clouds(const fs::path& folder) {
  std::error_code code;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry{folder, code}, end; !code && entry != end; entry.increment(code)) {
    std::error_code unknown;
    if (entry->is_regular_file(unknown) && is_cloud_file(entry->path())) files.push_back(entry->path());
  }
  if (code == std::errc::no_such_file_or_directory) return Error{Errc::not_found, "is not there", folder.string()};
  if (code) return Error{Errc::io_failure, "the folder cannot be read: " + code.message(), folder.string()};
  if (files.empty()) {
    return Error{Errc::not_found, "the folder holds no cloud (.pcd, .ply, .xyz, .txt, .csv, .pts, .bin)",
                 folder.string()};
  }
  std::sort(files.begin(), files.end());
  return files;
}

Status write_cloud(const fs::path& path, const CloudFile& cloud) {
  const auto* ply = std::get_if<PlyFile>(&cloud.file);
  if (path.extension() == ".ply") return ply != nullptr ? write_ply(path, *ply) : write_ply(path, cloud.fields());
  const PlyElement* vertices = ply != nullptr ? ply->find("vertex") : nullptr;
  if (vertices != nullptr && !vertices->lists.empty()) {
    return Error{Errc::unsupported,
                 "only a PLY can hold the list " + vertices->lists.front().name + " of the points; name a .ply",
                 path.string()};
  }
  if (has_text_cloud_suffix(path)) return write_text_cloud(path, cloud.fields());
  if (const auto* pcd = std::get_if<PcdFile>(&cloud.file)) return write_pcd(path, *pcd);
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
  const Column* radii = fields.find(kRadiusField);
  if (radii != nullptr && radii->count == 1) {
    cloud.radii_m.resize(fields.rows);
    for (std::size_t i = 0; i < fields.rows; ++i) cloud.radii_m[i] = static_cast<float>(radii->value(i));
  }
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
  std::vector<std::uint32_t> shown(labels.begin(), labels.end());
  for (std::uint32_t& label : shown) label += 1;  // kUnlabelled becomes 0
  static_assert(kUnlabelled + 1 == 0);
  return add_label_field(cloud, shown);
}

std::string add_label_field(CloudFile& cloud, std::span<const std::uint32_t> numbers) {
  return add_field(cloud, kLabelField, kEarlierLabelField, numbers);
}

std::string add_number_field(CloudFile& cloud, std::string_view name, std::span<const float> numbers) {
  return add_field(cloud, name, std::string{name} + "_input", numbers);
}

}  // namespace saccade
