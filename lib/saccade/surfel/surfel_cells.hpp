// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelCells: what fills the cells of an index image, in planes; associate_row: which surfels a row of pixels sees.
// For surfel_fusion.cpp.

#include <cstddef>
#include <vector>

#include "saccade/sensor/point_image.hpp"
#include "saccade/surfel/surfel_map.hpp"

namespace saccade {

/// What a pixel makes that sees no surfel.
inline constexpr SurfelId kMakesSurfel{kNoSurfel - 1};

/// The surfels of an index image in the camera's frame, with empty cells around the image.
class SurfelCells {
 public:
  static constexpr std::size_t kMargin{32};  ///< columns before and after a row, for whole vectors
  static constexpr float kNowhere{1e18F};    ///< its square is finite
  enum Plane : std::size_t { kX, kY, kZ, kSquaredRadius, kNx, kNy, kNz, kPlanes };

  SurfelCells() = default;
  SurfelCells(int width, int height);

  /// Cells (0, v) and on; v may be −1 or the height, u from −kMargin. Of an empty cell all is kNowhere.
  [[nodiscard]] float* row(Plane plane, int v) { return values_.data() + plane * plane_size_ + index(0, v); }
  [[nodiscard]] const float* row(Plane plane, int v) const {
    return values_.data() + plane * plane_size_ + index(0, v);
  }
  [[nodiscard]] SurfelId* ids(int v) { return ids_.data() + index(0, v); }
  [[nodiscard]] const SurfelId* ids(int v) const { return ids_.data() + index(0, v); }
  [[nodiscard]] int width() const { return width_; }

 private:
  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v + 1) * stride_ + kMargin + static_cast<std::size_t>(u);
  }

  int width_{0};
  std::size_t stride_{0};
  std::size_t plane_size_{0};
  std::vector<float> values_;
  std::vector<SurfelId> ids_;
};

/// How pixels and surfels fit together.
struct AssociationLimits {
  float fx, fy, cx, cy;
  float tolerance_m, growth_per_m;  ///< depths differ by no more than tolerance + growth · z²
  float normal_cosine;              ///< between normals, at least
  float view_cosine;                ///< between the normal and the way to the camera, of what makes a surfel
};

struct RowCounts {
  std::size_t points{0};
  std::size_t associated{0};
  std::size_t contradicted{0};
  std::size_t created{0};
};

/// Per pixel of row v: the surfel that it sees, kMakesSurfel or kNoSurfel. simd_target() changes nothing.
void associate_row(const SurfelCells& cells, const PointImage& points, const AssociationLimits& limits, int v,
                   SurfelId* of_pixel, RowCounts& counts);

}  // namespace saccade
