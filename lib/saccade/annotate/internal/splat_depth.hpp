// SPDX-License-Identifier: Apache-2.0
#pragma once
// SplatDepth: how far the nearest point is that each pixel shows.

#include <span>
#include <vector>

#include "saccade/annotate/selection.hpp"
#include "saccade/core/executor.hpp"

namespace saccade {

/// Depth buffer of points drawn as squares of constant depth around them: each covers the pixels whose centres (x, y)
/// fulfil u − s/2 < x ≤ u + s/2 and v − s/2 < y ≤ v + s/2, s² of them, its own among them. Between squares that do not
/// touch, what lies behind is seen, as in the thesis' tool (§4.2.2).
class SplatDepth {
 public:
  /// Of the pixels of a window inside the picture, on which so many points are to be drawn.
  SplatDepth(const PixelWindow& window, int point_size_px, std::size_t points, const Executor& executor);

  /// As many threads can draw at once, each on a layer of its own. Which point is drawn on which makes no difference.
  [[nodiscard]] std::size_t layers() const { return layers_.size(); }
  /// Draws points that are in view. O(1) each.
  void add(std::size_t layer, std::span<const ScreenPosition> positions);
  /// To be called when all points are drawn, once, before pixels are read. O(pixels · (layers + log point size)).
  void finish(const Executor& executor);
  /// Depth of a pixel in the window; infinite: it shows no point.
  [[nodiscard]] float depth_m(int u, int v) const { return layers_[0][offset(u, v)]; }

 private:
  [[nodiscard]] std::size_t offset(int u, int v) const {
    return static_cast<std::size_t>(v - top_) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u - left_);
  }

  int size_px_;
  int left_, top_, width_, height_;  ///< of the pixels where squares that reach into the window begin
  /// By a square's first pixel, and one place more for squares outside; at the end the first layer is by pixel.
  std::vector<std::vector<float>> layers_;
};

}  // namespace saccade
