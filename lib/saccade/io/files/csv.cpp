// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/csv.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace saccade {
namespace {

void append_quoted(std::string& text, std::string_view field) {
  if (field.find_first_of(",\"\r\n") == std::string_view::npos) {
    text += field;
    return;
  }
  text += '"';
  for (std::size_t quote = field.find('"'); quote != std::string_view::npos; quote = field.find('"')) {
    text.append(field.substr(0, quote + 1)) += '"';
    field.remove_prefix(quote + 1);
  }
  text.append(field) += '"';
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

template <class T>
CsvTable& CsvTable::add_number(T number) {
  begin_field();
  std::array<char, 32> buffer{};
  const auto [end, code] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
  if (code == std::errc{}) text_.append(buffer.data(), end);
  return *this;
}

CsvTable& CsvTable::add(double number) {
  // Integers below this are not shorter with an exponent, and are written much faster as integers.
  constexpr double kPlain{100'000.0};
  const bool is_integer = number > 0.0 && number < kPlain && number == std::floor(number);
  return is_integer ? add_number(static_cast<std::uint64_t>(number)) : add_number(number);
}

CsvTable& CsvTable::add(std::uint64_t number) { return add_number(number); }

CsvTable& CsvTable::add(const std::optional<double>& number) { return number ? add(*number) : add(std::string_view{}); }

CsvTable& CsvTable::add_fields(std::string_view fields, std::size_t count) {
  begin_field();
  fields_ += count - 1;
  text_ += fields;
  return *this;
}

void CsvTable::end_row() {
  SACCADE_EXPECTS(fields_ == columns_);
  fields_ = 0;
  text_ += '\n';
  row_ = text_.size();
}

Status CsvTable::move_to(AtomicFile& file) {
  SACCADE_EXPECTS(fields_ == 0);
  SACCADE_CHECK(file.write(text_));
  text_.clear();
  row_ = 0;
  return {};
}

Status CsvTable::write(const std::filesystem::path& path) const { return write_file_atomically(path, text_); }

}  // namespace saccade
