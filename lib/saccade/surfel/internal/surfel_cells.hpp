// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelCells: the surfels in the cells of an index image, in planes. associate_row: finds the surfels that a row of
// pixels sees. For surfel_fusion.cpp.

#include <cstddef>

#include "saccade/core/uninitialized_vector.hpp"
#include "saccade/sensor/point_image.hpp"
#include "saccade/surfel/surfel_map.hpp"

namespace saccade {

/// Mark of a pixel that sees no surfel and creates one.
inline constexpr SurfelId kMakesSurfel{kNoSurfel - 1};

/// Surfels of some rows of an index image in the camera's frame, with the rows above and below and empty cells on
/// either side: few enough to stay in a near cache.
class SurfelCells {
 public:
  static constexpr std::size_t kMargin{32};  ///< columns before and after a row, for whole vectors
  static constexpr float kNowhere{1e18F};    ///< its square is finite
  enum Plane : std::size_t { kX, kY, kZ, kSquaredRadius, kNx, kNy, kNz, kPlanes };

  /// Creates rows [begin, end). Rows begin − 1 to end have no value until they are written or emptied.
  SurfelCells(int width, int begin, int end);

  void set_empty(int v);
  /// Returns the cells (0, v) and on; u begins at −kMargin. Empty cells hold kNowhere in every plane.
  [[nodiscard]] float* row(Plane plane, int v) { return values_.data() + plane * plane_size_ + index(v); }
  [[nodiscard]] const float* row(Plane plane, int v) const { return values_.data() + plane * plane_size_ + index(v); }
  [[nodiscard]] SurfelId* ids(int v) { return ids_.data() + index(v); }
  [[nodiscard]] const SurfelId* ids(int v) const { return ids_.data() + index(v); }
  [[nodiscard]] int width() const { return width_; }

 private:
  [[nodiscard]] std::size_t index(int v) const { return static_cast<std::size_t>(v - first_) * stride_ + kMargin; }

  int width_;
  int first_;  ///< first row held
  std::size_t stride_;
  std::size_t plane_size_;
  UninitializedVector<float> values_;
  UninitializedVector<SurfelId> ids_;
};

/// Conditions for a pixel and a surfel to match.
struct AssociationLimits {
  float fx, fy, cx, cy;
  float tolerance_m, growth_per_m;  ///< depths differ by no more than tolerance + growth · z²
  float normal_cosine;              ///< smallest cosine between normals
  float view_cosine;                ///< smallest cosine between the normal and the direction to the camera, for new
                                    ///< surfels
};

struct RowCounts {
  std::size_t points{0};
  std::size_t associated{0};
  std::size_t contradicted{0};
  std::size_t created{0};
};

/// Finds for each pixel of row v the surfel that it sees, kMakesSurfel or kNoSurfel. simd_target() changes nothing.
void associate_row(const SurfelCells& cells, const PointImage& points, const AssociationLimits& limits, int v,
                   SurfelId* of_pixel, RowCounts& counts);

}  // namespace saccade
