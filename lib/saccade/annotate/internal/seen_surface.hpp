// SPDX-License-Identifier: Apache-2.0
#pragma once
// SeenSurface: how deep the points of a pixel belong to the surface that is seen there.

#include <vector>

#include "saccade/annotate/internal/splat_depth.hpp"
#include "saccade/annotate/selection.hpp"
#include "saccade/core/executor.hpp"

namespace saccade {

/// Depth limit of each pixel of a window. Overlapping squares of one surface hide each other's centres: where a surface
/// is oblique, rough or dense, hardly a point is the nearest one at its own pixel. A point is seen where any pixel of
/// its square shows it, so the limit begins at the farthest depth shown within half a square of the pixel. Added to it
/// is a tolerance for points of the surface that have no pixel of their own (see select_points).
class SeenSurface {
 public:
  /// Expects a finished depth buffer of surroundings().
  SeenSurface(const SplatDepth& drawn, const PixelWindow& window, const SelectionView& view,
              const ScreenProjection& project, double below_m, const Executor& executor);

  /// Returns the pixels of the image whose depths decide on those of a window.
  [[nodiscard]] static PixelWindow surroundings(const PixelWindow& window, const SelectionView& view);

  /// Returns the greatest depth of a point of this pixel that is selected. Expects a pixel with a point in it.
  [[nodiscard]] float limit_m(int u, int v) const {
    return limits_m_[static_cast<std::size_t>(v - window_.top) * static_cast<std::size_t>(window_.width()) +
                     static_cast<std::size_t>(u - window_.left)];
  }

 private:
  PixelWindow window_;
  std::vector<float> limits_m_;  ///< by row
};

}  // namespace saccade
