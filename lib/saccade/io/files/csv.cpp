// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/csv.hpp"

#include <array>
#include <charconv>

#include "saccade/io/files/file_io.hpp"

namespace saccade {
namespace {

template <class T>
void append_shortest(std::string& text, T number) {
  std::array<char, 32> buffer{};
  const auto [end, code] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
  if (code == std::errc{}) text.append(buffer.data(), end);
}

void append_quoted(std::string& text, std::string_view field) {
  if (field.find_first_of(",\"\r\n") == std::string_view::npos) {
    text += field;
    return;
  }
  text += '"';
  for (const char c : field) {
    if (c == '"') text += '"';
    text += c;
  }
  text += '"';
}

}  // namespace

CsvTable::CsvTable(const std::vector<std::string_view>& columns) : columns_{columns.size()} {
  for (const std::string_view column : columns) add(column);
  end_row();
}

void CsvTable::begin_field() {
  if (fields_++ > 0) text_ += ',';
}

CsvTable& CsvTable::add(std::string_view text) {
  begin_field();
  append_quoted(text_, text);
  return *this;
}

CsvTable& CsvTable::add(double number) {
  begin_field();
  append_shortest(text_, number);
  return *this;
}

CsvTable& CsvTable::add(std::uint64_t number) {
  begin_field();
  append_shortest(text_, number);
  return *this;
}

CsvTable& CsvTable::add(const std::optional<double>& number) { return number ? add(*number) : add(std::string_view{}); }

void CsvTable::end_row() {
  SACCADE_EXPECTS(fields_ == columns_);
  fields_ = 0;
  text_ += '\n';
}

Status CsvTable::write(const std::filesystem::path& path) const { return write_file_atomically(path, text_); }

}  // namespace saccade
