// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/scalar_fields.hpp"

#include <algorithm>
#include <array>

namespace saccade {

std::vector<std::string> scalar_field_names(const ColumnTable& fields) {
  constexpr std::array<std::string_view, 20> kOthers{"x",        "y",        "z",   "nx",   "ny",  "nz",    "normal_x",
                                                     "normal_y", "normal_z", "rgb", "rgba", "red", "green", "blue",
                                                     "alpha",    "r",        "g",   "b",    "_",   "label"};
  std::vector<std::string> names;
  for (const Column& column : fields.columns) {
    const bool is_other = std::find(kOthers.begin(), kOthers.end(), column.name) != kOthers.end();
    const bool is_first = fields.find(column.name) == &column;
    if (column.count == 1 && !is_other && is_first) names.push_back(column.name);
  }
  return names;
}

std::vector<float> scalar_values(const ColumnTable& fields, std::string_view name) {
  const Column* column = fields.find(name);
  SACCADE_EXPECTS(column != nullptr);
  std::vector<float> values;
  values.reserve(fields.rows);
  for (std::size_t row = 0; row < fields.rows; ++row) values.push_back(static_cast<float>(column->value(row)));
  return values;
}

}  // namespace saccade
