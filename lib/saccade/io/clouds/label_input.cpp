// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/label_io.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/clouds/internal/kitti_io.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/npy_io.hpp"
#include "saccade/io/files/text_scan.hpp"
#include "saccade/io/files/value_io.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

Result<std::vector<std::uint32_t>> labels_of(const Column& column) {
  if (column.type == ColumnType::u32) return column.values<std::uint32_t>();
  std::vector<std::uint32_t> labels(column.bytes.size() / bytes_of(column.type));
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const double value = column.value(i);
    if (value >= 0.0 && value <= std::numeric_limits<std::uint32_t>::max() && value == std::floor(value)) {
      labels[i] = static_cast<std::uint32_t>(value);
      continue;
    }
    std::string shown;
    append_text(&column.bytes[i * bytes_of(column.type)], column.type, shown);
    const std::string what = value < 0.0 ? " is negative" : " is not an integer below 2^32";
    return Error{Errc::corrupt_data, "the label " + shown + what, "point " + std::to_string(i)};
  }
  return labels;
}

/// Returns the field label; of a LAS without one its classes.
Result<Column> label_field(const ColumnTable& fields, bool is_las = false) {
  const Column* column = fields.find(kLabelField);
  if (column == nullptr && is_las) column = fields.find(kLasClassField);
  if (column == nullptr || column->count != 1) return Error{Errc::not_found, "has no field label", {}};
  return *column;
}

/// Tells a cloud from labels alone. The first line may be the number of points, as in a .pts.
bool has_several_fields(std::string_view text) {
  LineScanner lines{without_byte_order_mark(text)};
  constexpr std::size_t kPlaceAndLabel{4};
  std::size_t least = 2;
  while (const auto line = lines.next()) {
    if (is_comment(*line)) continue;
    if (fields_of(*line, separator_of(*line)).size() >= least) return true;
    if (least == kPlaceAndLabel) return false;
    least = kPlaceAndLabel;
  }
  return false;
}

Result<Column> text_labels(std::vector<std::byte> file) {
  if (!has_several_fields(as_text(file))) return parse_label_lines(as_text(file));
  SACCADE_TRY(const TextCloud cloud, parse_text_cloud(std::move(file)));
  return label_field(cloud.table);
}

Result<std::vector<std::uint32_t>> labels_in(const fs::path& path) {
  const std::string suffix = path.extension().string();
  if (suffix != ".label" && suffix != ".npy" && !has_text_cloud_suffix(path)) {
    SACCADE_TRY(const CloudFile cloud, read_cloud(path));
    SACCADE_TRY(const Column column,
                in_file(label_field(cloud.fields(), std::holds_alternative<LasFile>(cloud.file)), path));
    return in_file(labels_of(column), path);
  }
  SACCADE_TRY(std::vector<std::byte> file, read_file(path));
  if (suffix == ".label") return in_file(parse_kitti_labels(file), path);
  SACCADE_TRY(const Column column, in_file(suffix == ".npy" ? parse_npy(file) : text_labels(std::move(file)), path));
  return in_file(labels_of(column), path);
}

}  // namespace

Result<Column> parse_label_lines(std::string_view text) {
  Column column{std::string{kLabelField}, ColumnType::i64, 1, {}};
  LineScanner lines{without_byte_order_mark(text)};
  while (const auto line = lines.next()) {
    if (is_comment(*line)) continue;
    const std::vector<std::string_view> fields = fields_of(*line, separator_of(*line));
    if (fields.size() != 1) return bad_line(lines.line(), "one label per line is expected");
    if (column.bytes.empty() && fields[0] == kLabelField) continue;
    if (!append_token(fields[0], column.type, column.bytes)) {
      return bad_line(lines.line(), in_quotes(fields[0]) + " is not an integer");
    }
  }
  return column;
}

Result<std::vector<std::uint32_t>> read_labels(const fs::path& path, std::size_t points) {
  SACCADE_TRY(std::vector<std::uint32_t> labels, labels_in(path));
  if (labels.size() == points) return labels;
  return Error{Errc::size_mismatch,
               std::to_string(labels.size()) + " labels, but the cloud has " + std::to_string(points) + " points",
               path.string()};
}

}  // namespace saccade
