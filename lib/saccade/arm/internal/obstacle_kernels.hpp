// SPDX-License-Identifier: Apache-2.0
#pragma once
// Vector kernels of obstacle distances: one row of the distance transform, and spheres against the finished field.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace saccade::obstacle {

/// Rows are padded to so many cells.
constexpr std::size_t kRowStep{32};

/// Rows around one row, for a pass of the distance transform across rows.
struct RowWindow {
  const std::uint16_t* middle;  ///< the row itself
  std::ptrdiff_t stride;        ///< from a row to the next
  int before;                   ///< rows before the middle that take part
  int after;
  const std::uint16_t* costs;  ///< costs[k]: what k rows away adds to a squared distance; grows with k
};

/// out[i] = min(limit[i], min over k of row k [i] + costs[|k|]) for the cells of a row, kRowStep · steps of them.
/// @return whether `out` held anything else before.
[[nodiscard]] bool min_across_rows(const RowWindow& window, const std::uint16_t* limit, std::size_t steps,
                                   std::uint16_t* out);
/// The same, and the square roots of it.
void root_of_min_across_rows(const RowWindow& window, const std::uint16_t* limit, std::size_t steps, float* out);

/// The field in half cells: cell (x, y, z) has its centre at 2x + 1, 2y + 1, 2z + 1.
struct FieldView {
  const float* distances;  ///< per cell, from its centre to the nearest obstacle, at most; x fastest
  std::array<std::int32_t, 3> size;
  std::int32_t row_stride;
  std::array<float, 3> origin_m;
  float half_cells_per_m;
  float slack;  ///< half cells; above all rounding within the field
  float max_distance_m;
  /// Lower and upper corners in metres. The field holds their distances, too; points beyond it ask them.
  std::span<const std::array<float, 6>> fixtures;
};

/// Spheres in the world frame, as arrays of coordinates.
struct SphereArrays {
  const float* x_m;
  const float* y_m;
  const float* z_m;
  const float* radius_m;
};

/// Spheres that the field cannot say to be clear, bit i; count ≤ 64. None that touches an obstacle is missing, and none
/// with a coordinate that is not finite.
[[nodiscard]] std::uint64_t perhaps_touching(const FieldView& field, const SphereArrays& spheres, std::size_t count);

/// At most the distances of the centres, up to max_distance_m, less the radii; -∞ where a coordinate is not finite.
void clearances(const FieldView& field, const SphereArrays& spheres, std::size_t count, float* out);

}  // namespace saccade::obstacle
