// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/las_io.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "saccade/io/files/file_io.hpp"

namespace saccade {
namespace {

// Bytes of the public header block, LAS 1.4 R15 §2.4.
constexpr std::size_t kLeastHeader{227};
constexpr std::size_t kHeader14{375};
constexpr std::size_t kMinorAt{25}, kHeaderSizeAt{94}, kPointsBeginAt{96}, kFormatAt{104}, kRecordBytesAt{105};
constexpr std::size_t kCountAt{107}, kScaleAt{131}, kOffsetAt{155}, kCount14At{247};
constexpr std::array<std::size_t, 11> kFormatBytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr std::uint8_t kCompressedBits{0xC0};
constexpr std::uint8_t kOldClassBits{0x1F};  // formats 0 to 5 keep three flags above the class

template <class T>
T value_at(std::span<const std::byte> bytes, std::size_t at) {
  T value;
  std::memcpy(&value, &bytes[at], sizeof(T));
  return value;
}

Error corrupt(std::string what, std::size_t byte) {
  return {Errc::corrupt_data, std::move(what), "byte " + std::to_string(byte)};
}

/// Where a point format keeps its fields; 0 stands for a field that it lacks.
struct PointLayout {
  std::size_t classification{15};
  std::size_t scan_angle{16};
  std::size_t user_data{17};
  std::size_t point_source{18};
  std::size_t gps_time{0};
  std::size_t colors{0};
  std::size_t nir{0};
  bool extended{false};  ///< formats 6 to 10

  explicit PointLayout(int format) : extended{format >= 6} {
    constexpr std::array<std::size_t, 11> kGps{0, 20, 0, 20, 20, 20, 22, 22, 22, 22, 22};
    constexpr std::array<std::size_t, 11> kColors{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};
    gps_time = kGps[static_cast<std::size_t>(format)];
    colors = kColors[static_cast<std::size_t>(format)];
    if (format == 8 || format == 10) nir = 36;
    if (!extended) return;
    classification = 16;
    scan_angle = 18;
    point_source = 20;
  }
};

/// Columns of a file's records.
class RecordColumns {
 public:
  explicit RecordColumns(LasFile& las) : las_{las} {}

  template <class T, class Convert>
  void add(const char* name, Convert convert) {
    using Number = decltype(convert(T{}));
    Column column{name, column_type_of<Number>(), 1, std::vector<std::byte>(las_.table.rows * sizeof(Number))};
    for (std::size_t i = 0; i < las_.table.rows; ++i) {
      const Number number = convert(value_at<T>(las_.file, las_.points_begin + i * las_.record_bytes + at_));
      std::memcpy(&column.bytes[i * sizeof(Number)], &number, sizeof(Number));
    }
    las_.table.columns.push_back(std::move(column));
  }
  template <class T>
  void add(const char* name) {
    add<T>(name, [](T value) { return value; });
  }
  RecordColumns& at(std::size_t byte) {
    at_ = byte;
    return *this;
  }

 private:
  LasFile& las_;
  std::size_t at_{0};
};

/// Narrows colours to u8 where no channel exceeds 255: programs store 8 bits in 16.
void narrow_colors(ColumnTable& table, std::size_t first) {
  constexpr double kMost8{255.0};
  for (std::size_t k = first; k < first + 3; ++k) {
    for (std::size_t i = 0; i < table.rows; ++i) {
      if (table.columns[k].value(i) > kMost8) return;
    }
  }
  for (std::size_t k = first; k < first + 3; ++k) {
    Column bytes{table.columns[k].name, ColumnType::u8, 1, std::vector<std::byte>(table.rows)};
    for (std::size_t i = 0; i < table.rows; ++i) bytes.set_value(i, table.columns[k].value(i));
    table.columns[k] = std::move(bytes);
  }
}

void add_columns(LasFile& las) {
  const PointLayout layout{las.point_format};
  const std::span<const std::byte> header{las.file};
  RecordColumns columns{las};
  constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto scale = value_at<double>(header, kScaleAt + k * sizeof(double));
    const auto offset = value_at<double>(header, kOffsetAt + k * sizeof(double));
    columns.at(k * sizeof(std::int32_t)).add<std::int32_t>(kAxes[k], [=](std::int32_t v) {
      return v * scale + offset;
    });
  }
  columns.at(12).add<std::uint16_t>("intensity");
  columns.at(14).add<std::uint8_t>("returns");
  const auto class_of = [&](std::uint8_t v) -> std::uint8_t { return layout.extended ? v : v & kOldClassBits; };
  const auto flags_of = [&](std::uint8_t v) -> std::uint8_t { return layout.extended ? v : v >> 5U; };
  columns.at(layout.extended ? 15 : layout.classification).add<std::uint8_t>("class_flags", flags_of);
  columns.at(layout.classification).add<std::uint8_t>("classification", class_of);
  columns.at(layout.scan_angle);
  layout.extended ? columns.add<std::int16_t>("scan_angle") : columns.add<std::int8_t>("scan_angle");
  columns.at(layout.user_data).add<std::uint8_t>("user_data");
  columns.at(layout.point_source).add<std::uint16_t>("point_source");
  if (layout.gps_time > 0) columns.at(layout.gps_time).add<double>("gps_time");
  if (layout.colors > 0) {
    const std::size_t first = las.table.columns.size();
    columns.at(layout.colors).add<std::uint16_t>("red");
    columns.at(layout.colors + 2).add<std::uint16_t>("green");
    columns.at(layout.colors + 4).add<std::uint16_t>("blue");
    narrow_colors(las.table, first);
  }
  if (layout.nir > 0) columns.at(layout.nir).add<std::uint16_t>("nir");
}

/// Checks the header and sets where the points are.
Status read_header(LasFile& las) {
  const std::span<const std::byte> file{las.file};
  if (file.size() < kLeastHeader) return corrupt("the file ends within its header of 227 bytes", file.size());
  const auto major = value_at<std::uint8_t>(file, kMinorAt - 1);
  const auto minor = value_at<std::uint8_t>(file, kMinorAt);
  if (major != 1 || minor > 4) {
    return Error{
        Errc::unsupported, "LAS " + std::to_string(major) + "." + std::to_string(minor) + "; 1.0 to 1.4 are read", {}};
  }
  const auto format = value_at<std::uint8_t>(file, kFormatAt);
  if ((format & kCompressedBits) != 0) {
    return Error{Errc::unsupported,
                 "compressed (LAZ), which Saccade does not read; unpack it, for instance with "
                 "`laszip -i IN.laz -o OUT.las`, `pdal translate IN.laz OUT.las` or CloudCompare",
                 {}};
  }
  if (format >= kFormatBytes.size()) {
    return Error{Errc::unsupported, "point format " + std::to_string(format) + "; 0 to 10 are read",
                 "byte " + std::to_string(kFormatAt)};
  }
  las.point_format = format;
  las.points_begin = value_at<std::uint32_t>(file, kPointsBeginAt);
  las.record_bytes = value_at<std::uint16_t>(file, kRecordBytesAt);
  if (las.points_begin < std::max<std::size_t>(kLeastHeader, value_at<std::uint16_t>(file, kHeaderSizeAt)) ||
      las.points_begin > file.size()) {
    return corrupt("the points begin at byte " + std::to_string(las.points_begin) +
                       ", which is within the header or beyond the end of the file",
                   kPointsBeginAt);
  }
  if (las.record_bytes < kFormatBytes[format]) {
    return corrupt("a record of " + std::to_string(las.record_bytes) + " bytes; point format " +
                       std::to_string(format) + " takes " + std::to_string(kFormatBytes[format]) + " at least",
                   kRecordBytesAt);
  }
  std::uint64_t count = value_at<std::uint32_t>(file, kCountAt);
  if (minor >= 4 && las.points_begin >= kHeader14) count = value_at<std::uint64_t>(file, kCount14At);
  const std::size_t room = (file.size() - las.points_begin) / las.record_bytes;
  if (count > room) {
    return corrupt(
        "the file says that it holds " + std::to_string(count) + " points, but it ends after " + std::to_string(room),
        file.size());
  }
  for (std::size_t k = 0; k < 6; ++k) {
    if (!std::isfinite(value_at<double>(file, kScaleAt + k * sizeof(double)))) {
      return corrupt("a scale or an offset of the coordinates is not a number", kScaleAt + k * sizeof(double));
    }
  }
  las.table.rows = static_cast<std::size_t>(count);
  return {};
}

}  // namespace

bool is_las(std::string_view head) { return head.starts_with("LASF"); }

Result<LasFile> parse_las(std::vector<std::byte> file) {
  if (!is_las(as_text(file))) return corrupt("not a LAS file", 0);
  LasFile las;
  las.file = std::move(file);
  SACCADE_CHECK(read_header(las));
  add_columns(las);
  return las;
}

Status write_las_classes(const std::filesystem::path& path, const LasFile& las,
                         std::span<const std::uint32_t> classes) {
  if (classes.size() != las.table.rows) {
    return Error{Errc::size_mismatch,
                 std::to_string(classes.size()) + " classes for " + std::to_string(las.table.rows) + " points",
                 path.string()};
  }
  const PointLayout layout{las.point_format};
  std::vector<std::byte> file = las.file;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (classes[i] > las.greatest_class()) {
      return Error{Errc::unsupported,
                   "label " + std::to_string(classes[i]) + " of point " + std::to_string(i) + ": point format " +
                       std::to_string(las.point_format) + " of this LAS holds classes up to " +
                       std::to_string(las.greatest_class()) + "; name a .ply, .pcd or .csv",
                   path.string()};
    }
    std::byte& byte = file[las.points_begin + i * las.record_bytes + layout.classification];
    const auto flags = layout.extended ? std::byte{0} : byte & ~std::byte{kOldClassBits};
    byte = flags | static_cast<std::byte>(classes[i]);
  }
  return write_file_atomically(path, std::span<const std::byte>{file});
}

}  // namespace saccade
