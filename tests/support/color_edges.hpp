// SPDX-License-Identifier: Apache-2.0
#pragma once
// find_color_edges, edge_sharpness: how steeply renderings of a reconstruction change where a camera's image has edges.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "saccade/sensor/image.hpp"

namespace saccade::test {

/// Parameters of find_color_edges.
struct ColorEdgesConfig {
  double quantile{0.95};         ///< share of an image's gradients below those of edges
  int margin_px{5};              ///< around an edge: within it all pixels are inside the image and have depth without a
                                 ///< step
  double max_depth_step{0.025};  ///< between neighbours, relative to depth
};

/// A pixel on an edge.
struct ColorEdge {
  int u{0};
  int v{0};
  float du{0.0F};  ///< unit direction across the edge, towards what is brighter
  float dv{0.0F};
};

/// Means over edges.
struct EdgeSharpness {
  std::size_t edges{0};
  /// The steepest rise across the edge, within kEdgeSearch_px of it, since what is rendered may be displaced; luminance
  /// per pixel, over two pixels.
  double across{0.0};
  /// Rise along the edge per pixel, over two pixels, where none is expected: the effect of noise alone.
  double along{0.0};
};
constexpr int kEdgeSearch_px{2};

struct Gradients {
  Image<float> u, v, size;
};

inline Gradients sobel(const Image<float>& image) {
  const int width = image.width();
  const int height = image.height();
  Gradients gradients{Image<float>{width, height}, Image<float>{width, height}, Image<float>{width, height}};
  for (int v = 1; v + 1 < height; ++v) {
    for (int u = 1; u + 1 < width; ++u) {
      const auto at = [&](int du, int dv) { return image(u + du, v + dv); };
      const float du = at(1, -1) + 2.0F * at(1, 0) + at(1, 1) - at(-1, -1) - 2.0F * at(-1, 0) - at(-1, 1);
      const float dv = at(-1, 1) + 2.0F * at(0, 1) + at(1, 1) - at(-1, -1) - 2.0F * at(0, -1) - at(1, -1);
      gradients.u(u, v) = du;
      gradients.v(u, v) = dv;
      gradients.size(u, v) = std::hypot(du, dv);
    }
  }
  return gradients;
}

inline bool is_smooth_around(const DepthImage& depth, int u, int v, const ColorEdgesConfig& config) {
  for (int y = v - config.margin_px; y <= v + config.margin_px; ++y) {
    for (int x = u - config.margin_px; x <= u + config.margin_px; ++x) {
      const float z = depth(x, y);
      if (!(z > 0.0F)) return false;
      const auto limit = static_cast<float>(config.max_depth_step) * z;
      if (x > u - config.margin_px && !(std::abs(z - depth(x - 1, y)) <= limit)) return false;
      if (y > v - config.margin_px && !(std::abs(z - depth(x, y - 1)) <= limit)) return false;
    }
  }
  return true;
}

/// NaN outside the image, and next to what is not known.
inline float interpolated(const Image<float>& image, float u, float v) {
  const int u0 = static_cast<int>(std::floor(u));
  const int v0 = static_cast<int>(std::floor(v));
  if (u0 < 0 || v0 < 0 || u0 + 1 >= image.width() || v0 + 1 >= image.height()) {
    return std::numeric_limits<float>::quiet_NaN();
  }
  const float s = u - static_cast<float>(u0);
  const float t = v - static_cast<float>(v0);
  return (1.0F - t) * ((1.0F - s) * image(u0, v0) + s * image(u0 + 1, v0)) +
         t * ((1.0F - s) * image(u0, v0 + 1) + s * image(u0 + 1, v0 + 1));
}

struct Rises {
  float across, along;
};

/// None where something around is not known.
inline std::optional<Rises> steepest(const Image<float>& image, const ColorEdge& edge) {
  Rises most{std::numeric_limits<float>::lowest(), std::numeric_limits<float>::lowest()};
  const auto rise = [&](float u, float v, float du, float dv) {
    return 0.5F * (interpolated(image, u + du, v + dv) - interpolated(image, u - du, v - dv));
  };
  for (int k = -kEdgeSearch_px; k <= kEdgeSearch_px; ++k) {
    const float u = static_cast<float>(edge.u) + static_cast<float>(k) * edge.du;
    const float v = static_cast<float>(edge.v) + static_cast<float>(k) * edge.dv;
    const float across = rise(u, v, edge.du, edge.dv);
    const float along = rise(u, v, -edge.dv, edge.du);
    if (std::isnan(across) || std::isnan(along)) return std::nullopt;
    most.across = std::max(most.across, across);
    most.along = std::max(most.along, along);
  }
  return most;
}

/// Rec. 709 weights on the values as they are stored, in [0, 1].
[[nodiscard]] inline Image<float> luminance(const ColorImage& image) {
  Image<float> result{image.width(), image.height()};
  for (std::size_t i = 0; i < image.size(); ++i) {
    const Rgb8& color = image.pixels()[i];
    result.data()[i] = (0.2126F * static_cast<float>(color[0]) + 0.7152F * static_cast<float>(color[1]) +
                        0.0722F * static_cast<float>(color[2])) /
                       255.0F;
  }
  return result;
}

/// Maxima of the gradient of luminance (Sobel), across the edge, in row-major order.
/// @param depth  of the same size; 0 or NaN: no return.
[[nodiscard]] inline std::vector<ColorEdge> find_color_edges(const ColorImage& image, const DepthImage& depth,
                                                             const ColorEdgesConfig& config = {}) {
  SACCADE_EXPECTS(image.width() == depth.width() && image.height() == depth.height());
  SACCADE_EXPECTS(config.margin_px >= 1 && config.quantile >= 0.0 && config.quantile < 1.0);
  const Gradients gradients = sobel(luminance(image));
  std::vector<float> sizes = gradients.size.pixels();
  std::vector<ColorEdge> edges;
  if (sizes.empty()) return edges;
  const auto at_quantile =
      sizes.begin() + static_cast<std::ptrdiff_t>(config.quantile * static_cast<double>(sizes.size()));
  std::nth_element(sizes.begin(), at_quantile, sizes.end());
  const float least = std::max(*at_quantile, std::numeric_limits<float>::min());
  const int margin = config.margin_px;
  for (int v = margin; v + margin < image.height(); ++v) {
    for (int u = margin; u + margin < image.width(); ++u) {
      const float size = gradients.size(u, v);
      if (size < least) continue;
      const float du = gradients.u(u, v) / size;
      const float dv = gradients.v(u, v) / size;
      const int step_u = static_cast<int>(std::lround(du));
      const int step_v = static_cast<int>(std::lround(dv));
      if (gradients.size(u - step_u, v - step_v) > size || gradients.size(u + step_u, v + step_v) >= size) continue;
      if (is_smooth_around(depth, u, v, config)) edges.push_back({u, v, du, dv});
    }
  }
  return edges;
}

/// One result per rendering, of the same edges: those around which all renderings are known.
/// @param renderings  luminance; NaN where nothing is rendered. Expects images of the size in which edges were found.
[[nodiscard]] inline std::vector<EdgeSharpness> edge_sharpness(std::span<const ColorEdge> edges,
                                                               std::span<const Image<float>> renderings) {
  std::vector<EdgeSharpness> results(renderings.size());
  std::vector<Rises> rises(renderings.size());
  for (const ColorEdge& edge : edges) {
    bool known{true};
    for (std::size_t i = 0; i < renderings.size() && known; ++i) {
      const std::optional<Rises> found = steepest(renderings[i], edge);
      known = found.has_value();
      if (known) rises[i] = *found;
    }
    if (!known) continue;
    for (std::size_t i = 0; i < renderings.size(); ++i) {
      results[i].edges += 1;
      results[i].across += static_cast<double>(rises[i].across);
      results[i].along += static_cast<double>(rises[i].along);
    }
  }
  for (EdgeSharpness& result : results) {
    if (result.edges == 0) continue;
    result.across /= static_cast<double>(result.edges);
    result.along /= static_cast<double>(result.edges);
  }
  return results;
}

}  // namespace saccade::test
