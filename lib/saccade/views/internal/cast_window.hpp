// SPDX-License-Identifier: Apache-2.0
#pragma once
// CastWindow: the rays of one camera centre and roll that can score; window_of finds them.

#include <algorithm>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

#include "saccade/core/region.hpp"
#include "saccade/views/internal/footprint.hpp"
#include "saccade/views/sensor_rays.hpp"

namespace saccade {

/// Columns [begin, end) of a row.
struct ColumnRange {
  int begin{0};
  int end{0};
};

/// Rectangle of the canonical image, with the columns to cast in each row. The PixelAxes must outlive it.
struct CastWindow {
  SensorRays rays;
  std::span<const float> a;
  std::span<const float> b;
  double pixels_per_a{0.0};
  double pixels_per_b{0.0};
  std::vector<ColumnRange> columns{};  ///< empty: all columns of every row

  [[nodiscard]] bool empty() const { return a.empty() || b.empty(); }
  [[nodiscard]] ColumnRange columns_of(int row) const {
    return columns.empty() ? ColumnRange{0, static_cast<int>(a.size())} : columns[static_cast<std::size_t>(row)];
  }
  [[nodiscard]] PixelGrid grid() const {
    return {static_cast<double>(a.front()), static_cast<double>(b.front()), pixels_per_a, pixels_per_b,
            static_cast<int>(a.size()),     static_cast<int>(b.size())};
  }
  /// Tells whether the rays, and therefore the gain, are equal.
  [[nodiscard]] bool same_rays(const CastWindow& other) const {
    return rays.same_lattice(other.rays) && same_values(a, other.a) && same_values(b, other.b);
  }

 private:
  /// As std::ranges::equal. Windows of one quarter turn share their arrays, and those of others are mostly equal bit by
  /// bit: either is found sooner than that the numbers are equal one by one.
  [[nodiscard]] static bool same_values(std::span<const float> one, std::span<const float> other) {
    if (one.size() != other.size()) return false;
    return one.data() == other.data() || std::memcmp(one.data(), other.data(), one.size_bytes()) == 0 ||
           std::ranges::equal(one, other);
  }
};

/// Returns the window of all pixels of the image.
[[nodiscard]] CastWindow whole_image(const SensorRays& rays, const PixelAxes& axes);

/// Returns a window with at least the pixels whose rays meet a voxel in the box and, for a sphere, with its centre in
/// the sphere. It is bounded by the projections of the box and of the sphere enlarged by half a voxel's diagonal, plus
/// one pixel for rounding. `columns` stays empty: see column_ranges.
[[nodiscard]] CastWindow window_of(const SensorRays& rays, const PixelAxes& axes, const IndexBox& voxels,
                                   const Region& region, double voxel_size_m);

/// Returns for each row of the window the columns that can meet the region; empty, hence all columns, unless it is a
/// sphere.
[[nodiscard]] std::vector<ColumnRange> column_ranges(const CastWindow& window, const Region& region,
                                                     double voxel_size_m);

}  // namespace saccade
