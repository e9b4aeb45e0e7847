// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/internal/npy_cloud.hpp"

#include <algorithm>
#include <string>

#include "saccade/io/clouds/internal/unnamed_columns.hpp"
#include "saccade/io/files/npy_io.hpp"

namespace saccade {
namespace {

/// Replaces what no table may have in a name: blanks and control characters become '_', an empty name the field's
/// number.
void clean_names(ColumnTable& table) {
  constexpr unsigned char kDelete{0x7F};
  const auto bad = [](unsigned char c) { return c <= ' ' || c == kDelete; };
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    std::string& name = table.columns[k].name;
    std::replace_if(name.begin(), name.end(), bad, '_');
    if (name.empty()) name = "field" + std::to_string(k + 1);
  }
}

}  // namespace

Result<ColumnTable> parse_npy_cloud(std::span<const std::byte> file) {
  SACCADE_TRY(ColumnTable table, parse_npy_table(file));
  if (!table.columns.front().name.empty()) {
    for (const char* name : {"x", "y", "z"}) {
      if (table.find(name) == nullptr) {
        return Error{Errc::corrupt_data, std::string{"the records have no field "} + name, {}};
      }
    }
    clean_names(table);
    return table;
  }
  if (table.columns.size() < 3) {
    return Error{Errc::unsupported,
                 "an array of " + std::to_string(table.columns.size()) +
                     " columns; a cloud has one row per point and at least three columns, x, y and z",
                 {}};
  }
  if (table.rows <= 3 && table.columns.size() > table.rows && table.columns.size() > kMostUnnamedColumns) {
    return Error{
        Errc::unsupported, "one column per point; a cloud has one row per point: save the transposed array", {}};
  }
  name_columns(table);
  return table;
}

}  // namespace saccade
