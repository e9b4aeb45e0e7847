// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/cloud_io.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "saccade/io/clouds/internal/cloud_kind.hpp"
#include "saccade/io/clouds/internal/kitti_io.hpp"
#include "saccade/io/clouds/internal/npy_cloud.hpp"
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

/// Returns three columns with one number per row, or none.
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

/// Returns the median of a sample of the column's finite numbers: stray points do not move it.
double typical_value(const Column& column, std::size_t rows) {
  constexpr std::size_t kSamples{1001};
  const std::size_t step = std::max<std::size_t>(1, rows / kSamples);
  std::vector<double> values;
  for (std::size_t i = 0; i < rows; i += step) {
    if (const double value = column.value(i); std::isfinite(value)) values.push_back(value);
  }
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Returns the offset of a cloud far from its origin, otherwise zero.
Eigen::Vector3d offset_of(const std::vector<const Column*>& columns, std::size_t rows) {
  constexpr double kStep_m{100.0};
  Eigen::Vector3d typical_m;
  for (int axis = 0; axis < 3; ++axis) {
    typical_m[axis] = typical_value(*columns[static_cast<std::size_t>(axis)], rows);
  }
  const double farthest_m = typical_m.cwiseAbs().maxCoeff();
  constexpr double kMostOffset_m{1e8};  // beyond all maps of the Earth: damage, which an offset would hide
  if (farthest_m <= kFarFromOrigin_m || farthest_m > kMostOffset_m) return Eigen::Vector3d::Zero();
  return (typical_m / kStep_m).array().round() * kStep_m;
}

std::vector<Eigen::Vector3f> positions_of(const std::vector<const Column*>& columns, std::size_t rows,
                                          const Eigen::Vector3d& offset_m) {
  if (offset_m.isZero(0.0)) return vectors_of(columns, rows, 1.0);
  std::vector<Eigen::Vector3f> positions_m(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    const Eigen::Vector3d p{columns[0]->value(i), columns[1]->value(i), columns[2]->value(i)};
    positions_m[i] = (p - offset_m).cast<float>();
  }
  return positions_m;
}

/// Returns the scale of a colour: integers up to the type's largest stand for [0, 1].
double color_scale(ColumnType type) {
  if (type == ColumnType::f32 || type == ColumnType::f64) return 1.0;
  return 1.0 / (std::pow(2.0, 8.0 * static_cast<double>(bytes_of(type))) - 1.0);
}

/// Unpacks 0x00RRGGBB in the bits of a float or of an integer.
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

/// A scan of KITTI has no header, so a sample of its points decides: at least half must be within 10 km, which random
/// bytes are not.
bool is_plausible_scan(const ColumnTable& scan) {
  constexpr double kFarthest_m{1e4};
  constexpr double kLeast{1e-30};
  const auto plausible = [&](double v) { return v == 0.0 || (std::abs(v) > kLeast && std::abs(v) < kFarthest_m); };
  constexpr std::size_t kSamples{1000};
  const std::size_t step = std::max<std::size_t>(1, scan.rows / kSamples);
  std::size_t count{0};
  std::size_t sampled{0};
  for (std::size_t i = 0; i < scan.rows; i += step, ++sampled) {
    count += std::all_of(scan.columns.begin(), scan.columns.end(),
                         [&](const Column& column) { return plausible(column.value(i)); })
                 ? 1
                 : 0;
  }
  return 2 * count >= sampled;
}

/// Writes the field label, or the classes where there is none, into the bytes of the LAS that was read.
Status write_las(const fs::path& path, const CloudFile& cloud) {
  const auto* las = std::get_if<LasFile>(&cloud.file);
  if (las == nullptr) {
    return Error{Errc::unsupported, "only a cloud that was read from a LAS is written as one; name a .ply or .pcd",
                 path.string()};
  }
  const bool labelled = las->table.find(kLabelField) != nullptr;
  SACCADE_TRY(std::vector<std::uint32_t> classes,
              labels_from_fields(las->table, labelled ? kLabelField : kLasClassField));
  for (std::uint32_t& each : classes) each = each == kUnlabelled ? 0 : each;
  return write_las_classes(path, *las, classes);
}

/// @return the new name of an existing field; empty if there was none.
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
  if (const auto* las = std::get_if<LasFile>(&file)) return las->table;
  const PlyElement* vertices = std::get<PlyFile>(file).find("vertex");
  SACCADE_EXPECTS(vertices != nullptr);
  return vertices->table;
}

ColumnTable& CloudFile::fields() {
  if (auto* pcd = std::get_if<PcdFile>(&file)) return pcd->table;
  if (auto* text = std::get_if<TextCloud>(&file)) return text->table;
  if (auto* las = std::get_if<LasFile>(&file)) return las->table;
  PlyElement* vertices = vertices_of(std::get<PlyFile>(file));
  SACCADE_EXPECTS(vertices != nullptr);
  return vertices->table;
}

Result<CloudFile> read_cloud(const fs::path& path) {
  SACCADE_TRY(std::vector<std::byte> bytes, read_file(path));
  if (bytes.empty()) return Error{Errc::corrupt_data, "is empty; a cloud is expected", path.string()};
  const auto as_pcd = [](ColumnTable table) {
    PcdFile pcd;
    pcd.width = table.rows;
    pcd.table = std::move(table);
    return CloudFile{std::move(pcd)};
  };
  switch (kind_of_cloud(path, as_text(bytes).substr(0, kKindBytes))) {
    case CloudKind::ply: {
      SACCADE_TRY(PlyFile ply, in_file(parse_ply(bytes), path));
      if (vertices_of(ply) == nullptr) {
        return Error{Errc::corrupt_data, "is a PLY file without vertices", path.string()};
      }
      return CloudFile{std::move(ply)};
    }
    case CloudKind::pcd: {
      SACCADE_TRY(PcdFile pcd, in_file(parse_pcd(bytes), path));
      return CloudFile{std::move(pcd)};
    }
    case CloudKind::text: {
      SACCADE_TRY(TextCloud text, in_file(parse_text_cloud(std::move(bytes)), path));
      return CloudFile{std::move(text)};
    }
    case CloudKind::las: {
      SACCADE_TRY(LasFile las, in_file(parse_las(std::move(bytes)), path));
      return CloudFile{std::move(las)};
    }
    case CloudKind::npy: {
      SACCADE_TRY(ColumnTable table, in_file(parse_npy_cloud(bytes), path));
      return as_pcd(std::move(table));
    }
    case CloudKind::kitti: {
      SACCADE_TRY(ColumnTable scan, in_file(parse_kitti_scan(bytes), path));
      if (!is_plausible_scan(scan)) {
        return Error{Errc::corrupt_data,
                     "is not a scan of KITTI: its floats x, y, z and intensity make few plausible points",
                     path.string()};
      }
      return as_pcd(std::move(scan));
    }
    case CloudKind::e57:
      return Error{Errc::unsupported,
                   "is an E57, which Saccade does not read; convert it, for instance with "
                   "`CloudCompare -SILENT -O IN.e57 -C_EXPORT_FMT PLY -SAVE_CLOUDS`",
                   path.string()};
    case CloudKind::other: break;
  }
  return Error{Errc::corrupt_data,
               "is not a point cloud: neither PCD, PLY, LAS, a table of NumPy, a scan of KITTI (.bin) nor text with "
               "at least three numbers per line",
               path.string()};
}

bool has_cloud_suffix(const fs::path& path) {
  const std::string suffix = lower_suffix(path);
  constexpr std::array<std::string_view, 7> kBinary{".pcd", ".ply", ".las", ".laz", ".npy", ".bin", ".e57"};
  return std::find(kBinary.begin(), kBinary.end(), suffix) != kBinary.end() || has_text_cloud_suffix(path);
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
    return Error{Errc::not_found, "the folder holds no cloud (" + std::string{kCloudSuffixes} + ")", folder.string()};
  }
  std::sort(files.begin(), files.end());
  return files;
}

Status write_cloud(const fs::path& path, const CloudFile& cloud) {
  const std::string suffix = path.extension().string();
  if (suffix == ".las") return write_las(path, cloud);
  if (suffix == ".laz" || suffix == ".e57" || suffix == ".npy" || suffix == ".bin") {
    return Error{Errc::unsupported, "clouds are not written as " + suffix + "; name a .ply, .pcd, .las or text (.csv)",
                 path.string()};
  }
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
  cloud.offset_m = offset_of(positions, fields.rows);
  cloud.positions_m = positions_of(positions, fields.rows, cloud.offset_m);
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
      return Error{Errc::corrupt_data, "a label is not an integer from 0 to 2^32 - 1", "point " + std::to_string(i)};
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
