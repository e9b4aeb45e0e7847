// SPDX-License-Identifier: Apache-2.0
#include "saccade/sensor/mask.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace saccade {
namespace {

/// Returns where the polygons' edges cross the row of pixel centres v, ascending.
std::vector<double> row_crossings(std::span<const PixelPolygon> polygons, double v) {
  std::vector<double> crossings;
  for (const PixelPolygon& polygon : polygons) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector2d& a = polygon[i];
      const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
      if ((a.y() <= v) == (b.y() <= v)) continue;
      crossings.push_back(a.x() + (v - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
  }
  std::sort(crossings.begin(), crossings.end());
  return crossings;
}

/// Returns the first pixel centre at or right of x, within [0, width].
int first_pixel(double x, int width) { return static_cast<int>(std::clamp(std::ceil(x), 0.0, double(width))); }

}  // namespace

Result<MaskImage> mask_from_polygons(int width, int height, std::span<const PixelPolygon> ignored) {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "mask"}; };
  if (width <= 0 || height <= 0) return fail("the image size must be positive");
  for (const PixelPolygon& polygon : ignored) {
    if (polygon.size() < 3) return fail("a polygon needs at least 3 vertices");
    for (const Eigen::Vector2d& vertex : polygon) {
      if (!vertex.allFinite()) return fail("a polygon has a vertex that is not finite");
    }
  }
  MaskImage mask{width, height, 255};
  for (int v = 0; v < height; ++v) {
    const std::vector<double> crossings = row_crossings(ignored, v);
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const int begin = first_pixel(crossings[i], width);
      const int end = first_pixel(crossings[i + 1], width);
      std::fill(mask.row(v) + begin, mask.row(v) + std::max(begin, end), std::uint8_t{0});
    }
  }
  return mask;
}

Status apply_mask(const MaskImage& mask, DepthImage& depth) {
  if (mask.width() != depth.width() || mask.height() != depth.height()) {
    return Error{Errc::size_mismatch,
                 "the mask is " + std::to_string(mask.width()) + "x" + std::to_string(mask.height()) + ", the depth " +
                     std::to_string(depth.width()) + "x" + std::to_string(depth.height()),
                 "mask"};
  }
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (mask.data()[i] == 0) depth.data()[i] = 0.0F;
  }
  return {};
}

void clip_to_range(const PinholeCamera& camera, DepthImage& depth) {
  const auto nearest = static_cast<float>(camera.min_range_m);
  const auto farthest = static_cast<float>(camera.max_range_m);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    float& d = depth.data()[i];
    const bool returned = d >= nearest && d <= farthest;
    const bool seen_free = d < 0.0F && -d >= nearest;
    d = returned ? d : (seen_free ? std::max(d, -farthest) : 0.0F);
  }
}

}  // namespace saccade
