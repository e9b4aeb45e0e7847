// SPDX-License-Identifier: Apache-2.0
#pragma once
// CastWindow: the rays of one camera centre and roll that can score; window_of finds them.

#include <optional>
#include <vector>

#include "saccade/core/region.hpp"
#include "saccade/view/sensor_rays.hpp"

namespace saccade {

/// Columns [begin, end) of a row.
struct ColumnRange {
  int begin{0};
  int end{0};
};

/// A rectangle of the canonical image, and in each of its rows the columns to cast.
struct CastWindow {
  SensorRays rays;
  std::vector<float> a;
  std::vector<float> b;
  std::vector<ColumnRange> columns;

  [[nodiscard]] bool empty() const { return a.empty() || b.empty(); }
  /// The same rays, so the same gain.
  [[nodiscard]] bool same_rays(const CastWindow& other) const {
    return rays.same_lattice(other.rays) && a == other.a && b == other.b;
  }
};

/// All pixels of the image.
[[nodiscard]] CastWindow whole_image(const SensorRays& rays, const PixelAxes& axes);

/// At least the pixels whose rays meet a voxel that lies in the box of voxels and, for a sphere, whose centre lies in
/// the sphere: bounded by the projections of the box and of the sphere enlarged by half a voxel's diagonal, and by a
/// pixel more for rounding. `columns` stays empty: see column_ranges.
[[nodiscard]] CastWindow window_of(const SensorRays& rays, const PixelAxes& axes, const IndexBox& voxels,
                                   const Region& region, double voxel_size_m);

/// For each row of the window, the columns that can meet the region; all of them unless it is a sphere.
[[nodiscard]] std::vector<ColumnRange> column_ranges(const CastWindow& window, const Region& region,
                                                     double voxel_size_m);

}  // namespace saccade
