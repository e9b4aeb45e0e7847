// SPDX-License-Identifier: Apache-2.0
#include "reproduced_table.hpp"

#include <algorithm>

namespace saccade::reproduce {
namespace {

/// Characters, not bytes, of UTF-8.
std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

void print_row(std::ostream& out, const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    out << "| " << cells[i] << std::string(widths[i] - width_of(cells[i]) + 1, ' ');
  }
  out << "|\n";
}

}  // namespace

void print(std::ostream& out, const ReproducedTable& table) {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    std::size_t width = width_of(table.columns[i]);
    for (const auto& row : table.rows) width = std::max(width, width_of(row[i]));
    widths.push_back(width);
  }
  out << table.caption << "\n\n";
  print_row(out, table.columns, widths);
  for (const std::size_t width : widths) out << '|' << std::string(width + 2, '-');
  out << "|\n";
  for (const auto& row : table.rows) print_row(out, row, widths);
  out << '\n';
  for (const std::string& note : table.notes) out << "- " << note << '\n';
}

}  // namespace saccade::reproduce
