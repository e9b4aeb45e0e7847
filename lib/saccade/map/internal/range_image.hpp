// SPDX-License-Identifier: Apache-2.0
#pragma once
// RangeImage: distances along the rays of one depth image, and their bounds over rectangles.

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cstddef>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/map/internal/tsdf_math.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// Visibility within a rectangle of beams. A voxel nearer than `clear_m` is seen free (sample 1) in every beam of it
/// that saw something; a voxel farther than `reach_m` is seen in none.
struct BeamBounds {
  float clear_m{0.0F};
  float reach_m{0.0F};
  float nearest_m{0.0F};  ///< smallest range; 0: some beam saw nothing
};

/// Rectangle of pixels, inclusive.
struct PixelRect {
  int u0{0};
  int v0{0};
  int u1{-1};
  int v1{-1};
};

/// Ranges ‖p − o‖ of a depth image (eq. 2.1): 0 where there is no valid return, negative for "free up to". Keeps the
/// bounds of cells of 4×4 pixels, and of squares of 2, 4, … 16 cells from every cell, so that four overlapping squares
/// cover a small rectangle. Building is O(pixels); a query is O(1) up to 128 pixels and cheap beyond.
class RangeImage {
 public:
  /// Cells have 4×4 pixels.
  static constexpr int kCellShift{2};
  static constexpr int kCellPx{1 << kCellShift};
  static constexpr std::size_t kLevels{5};

  RangeImage(const PinholeCamera& camera, const DepthImage& depth, double truncation_m, const Executor& executor);

  [[nodiscard]] const tsdf::FusionCamera& camera() const { return camera_; }
  [[nodiscard]] const float* ranges() const { return ranges_.data(); }
  [[nodiscard]] std::size_t valid_pixels() const { return valid_pixels_; }
  /// Returns an upper bound of the reach over the whole image.
  [[nodiscard]] float max_reach_m() const { return max_reach_m_; }
  /// Returns conservative bounds over all pixels of `rect`, which must lie within the image.
  [[nodiscard]] BeamBounds bounds(const PixelRect& rect) const;

 private:
  /// Componentwise minimum: clear_m, −reach_m, nearest_m.
  using Least = Eigen::Array4f;
  [[nodiscard]] Least* level(std::size_t i) { return least_.data() + i * level_size_; }
  [[nodiscard]] const Least* level(std::size_t i) const { return least_.data() + i * level_size_; }
  void bound_squares();
  [[nodiscard]] static std::size_t row_offset(int row, int width) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width);
  }

  tsdf::FusionCamera camera_;
  std::vector<float> ranges_;
  std::size_t valid_pixels_{0};
  int width_cells_;
  int height_cells_;
  std::size_t level_size_;
  std::vector<Least> least_;  ///< level k: the square of 2^k × 2^k cells from each cell
  float max_reach_m_{0.0F};
};

inline BeamBounds RangeImage::bounds(const PixelRect& rect) const {
  const int x0 = rect.u0 >> kCellShift;
  const int y0 = rect.v0 >> kCellShift;
  const int x1 = (rect.u1 >> kCellShift) + 1;
  const int y1 = (rect.v1 >> kCellShift) + 1;
  // Covers the rectangle with the largest square that fits; the last square of a row or column ends where the rectangle
  // does.
  const auto edge_cells = static_cast<unsigned>(std::min(x1 - x0, y1 - y0));
  const std::size_t k = std::min(static_cast<std::size_t>(std::bit_width(edge_cells)) - 1, kLevels - 1);
  const int square = 1 << k;
  const Least* squares = level(k);
  if (std::max(x1 - x0, y1 - y0) <= 2 * square) {  // one to four squares: the loop below without branches
    const Least* upper = squares + row_offset(y0, width_cells_);
    const Least* lower = squares + row_offset(y1 - square, width_cells_);
    const Least least = upper[x0].min(upper[x1 - square]).min(lower[x0].min(lower[x1 - square]));
    return {least[0], -least[1], least[2]};
  }
  Least least = squares[row_offset(y0, width_cells_) + static_cast<std::size_t>(x0)];
  for (int y = y0; y < y1; y += square) {
    const Least* row = squares + row_offset(std::min(y, y1 - square), width_cells_);
    for (int x = x0; x < x1; x += square) least = least.min(row[std::min(x, x1 - square)]);
  }
  return {least[0], -least[1], least[2]};
}

}  // namespace saccade
