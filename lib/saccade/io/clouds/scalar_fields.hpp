// SPDX-License-Identifier: Apache-2.0
#pragma once
// scalar_field_names, scalar_values: the columns of a cloud that it can be coloured by.

#include <string>
#include <string_view>
#include <vector>

#include "saccade/io/files/column_table.hpp"

namespace saccade {

/// Columns with one number per point, but for places, normals, colours, labels and padding; in the file's order.
[[nodiscard]] std::vector<std::string> scalar_field_names(const ColumnTable& fields);
/// One number per row. Expects that there is such a column. O(rows).
[[nodiscard]] std::vector<float> scalar_values(const ColumnTable& fields, std::string_view name);

}  // namespace saccade
