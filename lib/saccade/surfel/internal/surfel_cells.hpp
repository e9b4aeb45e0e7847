// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelCells: what fills the cells of an index image, in planes; associate_row: which surfels a row of pixels sees.
// For surfel_fusion.cpp.

#include <cstddef>

#include "saccade/core/unset_vector.hpp"
#include "saccade/sensor/point_image.hpp"
#include "saccade/surfel/surfel_map.hpp"

namespace saccade {

/// What a pixel makes that sees no surfel.
inline constexpr SurfelId kMakesSurfel{kNoSurfel - 1};

/// The surfels of some rows of an index image in the camera's frame, with those above and below and empty cells on
/// either side: few enough to stay in a near cache.
class SurfelCells {
 public:
  static constexpr std::size_t kMargin{32};  ///< columns before and after a row, for whole vectors
  static constexpr float kNowhere{1e18F};    ///< its square is finite
  enum Plane : std::size_t { kX, kY, kZ, kSquaredRadius, kNx, kNy, kNz, kPlanes };

  /// For rows [begin, end): rows begin − 1 to end have no value until they are written or emptied.
  SurfelCells(int width, int begin, int end);

  void set_empty(int v);
  /// Cells (0, v) and on; u from −kMargin. Of an empty cell all is kNowhere.
  [[nodiscard]] float* row(Plane plane, int v) { return values_.data() + plane * plane_size_ + index(v); }
  [[nodiscard]] const float* row(Plane plane, int v) const { return values_.data() + plane * plane_size_ + index(v); }
  [[nodiscard]] SurfelId* ids(int v) { return ids_.data() + index(v); }
  [[nodiscard]] const SurfelId* ids(int v) const { return ids_.data() + index(v); }
  [[nodiscard]] int width() const { return width_; }

 private:
  [[nodiscard]] std::size_t index(int v) const { return static_cast<std::size_t>(v - first_) * stride_ + kMargin; }

  int width_;
  int first_;  ///< row that is kept first
  std::size_t stride_;
  std::size_t plane_size_;
  UnsetVector<float> values_;
  UnsetVector<SurfelId> ids_;
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
