// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>

#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/clouds/text_cloud.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/text_scan.hpp"
#include "saccade/io/files/value_io.hpp"

namespace saccade {
namespace {

bool is_csv(const std::filesystem::path& path) { return path.extension() == ".csv" || path.extension() == ".CSV"; }

void add_separator(std::string& row, char separator) {
  if (!row.empty()) row.push_back(separator);
}

/// Returns a name for a header: characters that would end it become underscores.
std::string header_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ',' || c == ';'; }, '_');
  return name;
}

bool is_packed_color(const Column& column) {
  return (column.name == "rgb" || column.name == "rgba") && column.type == ColumnType::f32;
}

std::string names_line(const ColumnTable& table, char separator) {
  std::string header;
  for (const Column& column : table.columns) {
    if (column.name == "_") continue;
    for (std::size_t k = 0; k < column.count; ++k) {
      add_separator(header, separator);
      header += header_name(column.name);
      if (column.count > 1) header.append("_").append(std::to_string(k));
    }
  }
  return header;
}

void append_row(const ColumnTable& table, std::size_t i, char separator, std::string& row) {
  for (const Column& column : table.columns) {
    if (column.name == "_") continue;
    const ColumnType type = is_packed_color(column) ? ColumnType::u32 : column.type;
    for (std::size_t k = 0; k < column.count; ++k) {
      add_separator(row, separator);
      append_text(column.bytes.data() + i * column.row_bytes() + k * bytes_of(type), type, row);
    }
  }
}

/// Returns a line with one more field at its end, with its own or another separator.
std::string extended(std::string_view line, char separator, char wanted, std::string_view added) {
  std::string row;
  line = trimmed(line);
  if (separator == wanted && !line.ends_with(separator)) {
    row = line;
  } else {
    FieldScanner fields{line, separator};
    bool first = true;
    while (const auto field = fields.next()) {
      if (!std::exchange(first, false)) row.push_back(wanted);
      row += *field;
    }
  }
  const bool has_tabs =
      separator == kBlankSeparator && wanted == separator && line.find('\t') != std::string_view::npos;
  row.push_back(has_tabs ? '\t' : wanted);
  return row.append(added);
}

/// Returns the line that names the columns, with label as the last name and no other of that name. With another
/// separator the names are those of the table, which have no blanks.
std::string labelled_header(std::string_view line, const ColumnTable& table, char wanted) {
  const bool commented = is_comment(line);
  const std::string_view names = commented ? comment_text(line) : line;
  const char separator = separator_of(names);
  std::string text{names};
  const std::vector<std::string_view> fields = fields_of(names, separator);
  for (std::size_t i = fields.size(); i-- > 0;) {  // backwards, so that the other indices stay valid
    const std::string& name = table.columns[i].name;
    const bool is_label = name == kLabelField;
    if (!is_label && separator == wanted) continue;
    text.replace(static_cast<std::size_t>(fields[i].data() - names.data()), fields[i].size(),
                 is_label ? table.unused_name(kEarlierLabelField) : header_name(name));
  }
  const std::string mark{line.substr(0, line.size() - names.size())};
  return mark + extended(text, separator, wanted, kLabelField);
}

/// Returns the separator that the suffix requires, otherwise the cloud's. Decimal commas stay, so none separates them.
char wanted_separator(const std::filesystem::path& path, const TextCloud& cloud) {
  const char separator = cloud.separator;
  if (is_csv(path) && separator == kBlankSeparator) return cloud.decimal_comma ? ';' : ',';
  const std::string suffix = path.extension().string();
  return suffix == ".xyz" || suffix == ".XYZ" ? kBlankSeparator : separator;
}

}  // namespace

Status write_text_cloud(const std::filesystem::path& path, const ColumnTable& table) {
  SACCADE_CHECK(table.validate());
  const char separator = is_csv(path) ? ',' : ' ';
  SACCADE_TRY(AtomicFile out, AtomicFile::create(path));
  SACCADE_CHECK(out.write((is_csv(path) ? "" : "# ") + names_line(table, separator) + "\n"));
  std::string row;
  for (std::size_t i = 0; i < table.rows; ++i) {
    row.clear();
    append_row(table, i, separator, row);
    row.push_back('\n');
    SACCADE_CHECK(out.write(row));
  }
  return out.commit();
}

Status write_labelled_text(const std::filesystem::path& path, const TextCloud& cloud,
                           std::span<const std::uint32_t> labels) {
  SACCADE_EXPECTS(labels.size() == cloud.table.rows);
  const char wanted = wanted_separator(path, cloud);
  SACCADE_TRY(AtomicFile out, AtomicFile::create(path));
  LineScanner lines{without_byte_order_mark(as_text(cloud.file))};
  std::size_t row{0};
  while (const auto line = lines.next()) {
    std::string text{*line};
    if (lines.line() == cloud.header_line) {
      text = labelled_header(*line, cloud.table, wanted);
    } else if (lines.line() >= cloud.first_row_line && !is_comment(*line)) {
      text = extended(*line, cloud.separator, wanted, std::to_string(labels[row++]));
    }
    if (lines.line() == cloud.first_row_line && cloud.header_line == 0) {
      text.insert(0, "# " + names_line(cloud.table, wanted) + wanted + std::string{kLabelField} + "\n");
    }
    SACCADE_CHECK(out.write(text.append("\n")));
  }
  return out.commit();
}

}  // namespace saccade
