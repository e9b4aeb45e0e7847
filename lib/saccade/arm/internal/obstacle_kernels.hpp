// SPDX-License-Identifier: Apache-2.0
#pragma once
// Vector kernels of obstacle distances: one row of the distance transform, and tests of spheres against the finished
// field.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace saccade::obstacle {

/// Rows are padded to a multiple of kRowStep cells.
constexpr std::size_t kRowStep{32};

/// Neighbouring rows of a row, for a pass of the distance transform across rows.
struct RowWindow {
  const std::uint16_t* middle;  ///< the row itself
  std::ptrdiff_t stride;        ///< from one row to the next
  int before;                   ///< rows before the middle that are included
  int after;
  const std::uint16_t* costs;  ///< costs[k]: squared distance added by k rows; grows with k
};

/// Computes out[i] = min(limit[i], min over k of row k [i] + costs[|k|]) for kRowStep · steps cells of a row.
/// @return whether `out` changed.
[[nodiscard]] bool min_across_rows(const RowWindow& window, const std::uint16_t* limit, std::size_t steps,
                                   std::uint16_t* out);
/// As min_across_rows, and writes the square roots.
void root_of_min_across_rows(const RowWindow& window, const std::uint16_t* limit, std::size_t steps, float* out);

/// The field in half cells: cell (x, y, z) has its centre at 2x + 1, 2y + 1, 2z + 1.
struct FieldView {
  const float* distances;  ///< per cell, upper limit of the distance from its centre to the nearest obstacle; x fastest
  std::array<std::int32_t, 3> size;
  std::int32_t row_stride;
  std::array<float, 3> origin_m;
  float half_cells_per_m;
  float slack;  ///< half cells; exceeds all rounding within the field
  float max_distance_m;
  /// Lower and upper corners in metres. The field includes their distances; points outside it are tested against the
  /// boxes.
  std::span<const std::array<float, 6>> fixtures;
};

/// Spheres in the world frame, as arrays of coordinates.
struct SphereArrays {
  const float* x_m;
  const float* y_m;
  const float* z_m;
  const float* radius_m;
};

/// Returns the spheres that are not known to be clear by the field, bit i; count ≤ 64. Includes every sphere that
/// touches an obstacle or has a coordinate that is not finite.
[[nodiscard]] std::uint64_t perhaps_touching(const FieldView& field, const SphereArrays& spheres, std::size_t count);

/// Computes lower bounds of the centres' distances, up to max_distance_m, minus the radii; -∞ where a coordinate is not
/// finite.
void clearances(const FieldView& field, const SphereArrays& spheres, std::size_t count, float* out);

}  // namespace saccade::obstacle
