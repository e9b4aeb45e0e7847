// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/csv.hpp"

#include <array>
#include <charconv>

#include "saccade/io/files/file_io.hpp"

namespace saccade {
namespace {

template <class T>
std::string shortest(T number) {
  std::array<char, 32> buffer{};
  const auto [end, code] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
  return code == std::errc{} ? std::string{buffer.data(), end} : std::string{};
}

std::string quoted(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string{text};
  std::string result{'"'};
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

}  // namespace

CsvTable::CsvTable(const std::vector<std::string_view>& columns) : columns_{columns.size()} {
  for (const std::string_view column : columns) add(column);
  end_row();
}

CsvTable& CsvTable::add(std::string_view text) {
  if (fields_++ > 0) text_ += ',';
  text_ += quoted(text);
  return *this;
}

CsvTable& CsvTable::add(double number) { return add(std::string_view{shortest(number)}); }

CsvTable& CsvTable::add(std::uint64_t number) { return add(std::string_view{shortest(number)}); }

CsvTable& CsvTable::add(const std::optional<double>& number) { return number ? add(*number) : add(std::string_view{}); }

void CsvTable::end_row() {
  SACCADE_EXPECTS(fields_ == columns_);
  fields_ = 0;
  text_ += '\n';
}

Status CsvTable::write(const std::filesystem::path& path) const { return write_file_atomically(path, text_); }

}  // namespace saccade
