// SPDX-License-Identifier: Apache-2.0
#pragma once
// Footprint: the pixels of a window whose rays may score, judged by the faces of scoring voxels.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "saccade/views/internal/entry_faces.hpp"
#include "saccade/views/sensor_rays.hpp"

namespace saccade {

/// Evenly spaced pixels in canonical image coordinates: column i lies at first_a + i / pixels_per_a.
struct PixelGrid {
  double first_a{0.0};
  double first_b{0.0};
  double pixels_per_a{1.0};
  double pixels_per_b{1.0};
  int columns{0};
  int rows{0};
};

/// Pixels [begin, end) of a grid.
struct PixelRectangle {
  int column_begin;
  int column_end;
  int row_begin;
  int row_end;
};

/// Pixels whose rays pass, within rounding, the bounding box in the image of a square of faces that is turned towards
/// the camera and within the sensor's depths. Occlusion is ignored. All other rays score nothing, so the count bounds
/// the gain from above.
class Footprint {
 public:
  /// Draws all faces. `min_t`, `max_t`: the sensor's range in metres. O(faces near the view + pixels they cover).
  void draw(const EntryFaces& faces, const SensorRays& rays, const PixelGrid& grid, double voxel_size_m, float min_t,
            float max_t);

  [[nodiscard]] bool test(int column, int row) const {
    const std::size_t at = static_cast<std::size_t>(row) * stride_ + static_cast<std::size_t>(column) / 8;
    return (bytes_[at] >> (column & 7) & 1U) != 0;
  }
  [[nodiscard]] std::uint64_t count(const PixelRectangle& pixels) const;

 private:
  std::size_t stride_{0};  ///< bytes of a row
  std::vector<std::uint8_t> bytes_;
};

}  // namespace saccade
