// SPDX-License-Identifier: Apache-2.0
#pragma once
// parse_npy_cloud: a point cloud as an array of NumPy, one row or record per point.

#include <cstddef>
#include <span>

#include "saccade/core/result.hpp"
#include "saccade/io/files/column_table.hpp"

namespace saccade {

/// Reads N x 3 numbers (x y z), N x 4 (x y z intensity), N x 6 (x y z and colours of 0 … 1 or 0 … 255, or unit normals)
/// or N x K (x y z value3 …), in C or Fortran order; or records with fields x, y and z.
/// @return corrupt_data for records without x, y and z; unsupported for other shapes; errors as parse_npy_table.
/// O(file).
[[nodiscard]] Result<ColumnTable> parse_npy_cloud(std::span<const std::byte> file);

}  // namespace saccade
