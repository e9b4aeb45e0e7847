// SPDX-License-Identifier: Apache-2.0
#pragma once
// find_color_edges, edge_sharpness: how steeply renderings of a reconstruction change where a camera's image has edges.

#include <span>
#include <vector>

#include "saccade/sensor/image.hpp"

namespace saccade {

/// Parameters of find_color_edges.
struct ColorEdgesConfig {
  double quantile{0.95};         ///< of an image's gradients: edges are steeper than so large a share of the pixels
  int margin_px{5};              ///< around an edge: all is inside the image, has depth, and no step in depth
  double max_depth_step{0.025};  ///< between neighbours, relative to depth
};

/// A pixel on an edge.
struct ColorEdge {
  int u{0};
  int v{0};
  float du{0.0F};  ///< unit direction across the edge, towards what is brighter
  float dv{0.0F};
};

/// Rec. 709 weights on the values as they are stored, in [0, 1].
[[nodiscard]] Image<float> luminance(const ColorImage& image);

/// Maxima of the gradient of luminance (Sobel), across the edge, in row-major order.
/// @param depth  of the same size; 0 or NaN: no return.
[[nodiscard]] std::vector<ColorEdge> find_color_edges(const ColorImage& image, const DepthImage& depth,
                                                      const ColorEdgesConfig& config = {});

/// Means over edges.
struct EdgeSharpness {
  std::size_t edges{0};
  /// The steepest rise across the edge, within kEdgeSearch_px of it, since what is rendered may be displaced; luminance
  /// per pixel, over two pixels.
  double across{0.0};
  /// The same of rises along the edge, where there is none to be found: what noise alone gives.
  double along{0.0};
};
constexpr int kEdgeSearch_px{2};

/// One result per rendering, of the same edges: those around which all renderings are known.
/// @param renderings  luminance; NaN where nothing is rendered. Expects images of the size in which edges were found.
[[nodiscard]] std::vector<EdgeSharpness> edge_sharpness(std::span<const ColorEdge> edges,
                                                        std::span<const Image<float>> renderings);

}  // namespace saccade
