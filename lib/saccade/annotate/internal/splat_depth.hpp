// SPDX-License-Identifier: Apache-2.0
#pragma once
// SplatDepth: depth of the nearest point shown by each pixel.

#include <span>
#include <vector>

#include "saccade/annotate/selection.hpp"
#include "saccade/core/executor.hpp"

namespace saccade {

/// Depth buffer of points drawn as squares of constant depth. Each covers the s² pixels whose centres (x, y) satisfy u
/// − s/2 < x ≤ u + s/2 and v − s/2 < y ≤ v + s/2, including its own. Points behind are visible between squares that do
/// not touch, as in the thesis' tool (§4.2.2).
class SplatDepth {
 public:
  /// Creates the buffer for the pixels of a window inside the image; `points` is the expected number of points.
  SplatDepth(const PixelWindow& window, int point_size_px, std::size_t points, const Executor& executor);

  /// Number of layers, hence of threads that can draw at once. The assignment of points to layers makes no difference.
  [[nodiscard]] std::size_t layers() const { return layers_.size(); }
  /// Draws points that are in view. O(1) each.
  void add(std::size_t layer, std::span<const ScreenPosition> positions);
  /// Finishes drawing. Call it once after all points, before pixels are read. O(pixels · (layers + log point size)).
  void finish(const Executor& executor);
  /// Returns the depth of a pixel in the window; infinite where it shows no point.
  [[nodiscard]] float depth_m(int u, int v) const { return layers_[0][offset(u, v)]; }
  /// Returns the depths of the pixels from (u, v) on in a row of the window.
  [[nodiscard]] const float* row(int u, int v) const { return layers_[0].data() + offset(u, v); }

 private:
  [[nodiscard]] std::size_t offset(int u, int v) const {
    return static_cast<std::size_t>(v - top_) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u - left_);
  }

  int size_px_;
  int left_, top_, width_, height_;  ///< area of the first pixels of squares that reach into the window
  /// Indexed by a square's first pixel, with one extra place for squares outside; after finish() the first layer is by
  /// pixel.
  std::vector<std::vector<float>> layers_;
};

}  // namespace saccade
