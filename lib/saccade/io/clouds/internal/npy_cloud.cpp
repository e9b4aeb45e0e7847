// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/internal/npy_cloud.hpp"

#include <string>

#include "saccade/io/clouds/internal/unnamed_columns.hpp"
#include "saccade/io/files/npy_io.hpp"

namespace saccade {

Result<ColumnTable> parse_npy_cloud(std::span<const std::byte> file) {
  SACCADE_TRY(ColumnTable table, parse_npy_table(file));
  if (!table.columns.front().name.empty()) {
    for (const char* name : {"x", "y", "z"}) {
      if (table.find(name) == nullptr) {
        return Error{Errc::corrupt_data, std::string{"the records have no field "} + name, {}};
      }
    }
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
