// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/internal/plane_drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "saccade/report/internal/blend.hpp"

namespace saccade {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Blends `color` into the pixels around the points, by the opacity that opacity_at says.
template <class OpacityAt>
void blend_around(ColorImage& image, std::span<const Eigen::Vector2d> points, double margin_px, const Rgb8& color,
                  const OpacityAt& opacity_at) {
  Eigen::Vector2d lo = points.front();
  Eigen::Vector2d hi = points.front();
  for (const Eigen::Vector2d& p : points) {
    lo = lo.cwiseMin(p);
    hi = hi.cwiseMax(p);
  }
  const auto pixel = [](double at, int size) { return static_cast<int>(std::clamp(at, -1.0, 1.0 * size)); };
  const int u_end = std::min(image.width() - 1, pixel(hi.x() + margin_px, image.width()));
  const int v_end = std::min(image.height() - 1, pixel(hi.y() + margin_px, image.height()));
  for (int v = std::max(0, pixel(lo.y() - margin_px, image.height())); v <= v_end; ++v) {
    for (int u = std::max(0, pixel(lo.x() - margin_px, image.width())); u <= u_end; ++u) {
      const double opacity = opacity_at(Eigen::Vector2d{u, v});
      if (opacity > 0.0) image(u, v) = blend(image(u, v), color, std::min(opacity, 1.0));
    }
  }
}

void draw_solid(ColorImage& image, const Eigen::Vector2d& a, const Eigen::Vector2d& b, const StrokeStyle& style) {
  const Eigen::Vector2d along = b - a;
  const double length_squared = along.squaredNorm();
  const double reach = 0.5 * style.width_px + 0.5;
  const std::array<Eigen::Vector2d, 2> ends{a, b};
  blend_around(image, ends, reach + 1.0, style.color, [&](const Eigen::Vector2d& p) {
    const double s = length_squared > 0.0 ? std::clamp((p - a).dot(along) / length_squared, 0.0, 1.0) : 0.0;
    return reach - (p - a - s * along).norm();
  });
}

}  // namespace

void draw_stroke(ColorImage& image, const Eigen::Vector2d& a, const Eigen::Vector2d& b, const StrokeStyle& style) {
  const double length = (b - a).norm();
  if (!(style.dash_px > 0.0) || !(length > 0.0)) {
    draw_solid(image, a, b, style);
    return;
  }
  const Eigen::Vector2d direction = (b - a) / length;
  for (double at = 0.0; at < length; at += 2.0 * style.dash_px) {
    draw_solid(image, a + at * direction, a + std::min(at + style.dash_px, length) * direction, style);
  }
}

void draw_outline(ColorImage& image, std::span<const Eigen::Vector2d> corners, const StrokeStyle& style) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    draw_stroke(image, corners[i], corners[(i + 1) % corners.size()], style);
  }
}

void fill_convex(ColorImage& image, std::span<const Eigen::Vector2d> corners, const Rgb8& color, double opacity) {
  if (corners.size() < 3) return;
  double area{0.0};
  for (std::size_t i = 0; i < corners.size(); ++i) area += cross(corners[i], corners[(i + 1) % corners.size()]);
  const double sign = area > 0.0 ? 1.0 : -1.0;
  blend_around(image, corners, 1.0, color, [&](const Eigen::Vector2d& p) {
    double inside{1.0};
    for (std::size_t i = 0; i < corners.size() && inside > 0.0; ++i) {
      const Eigen::Vector2d edge = corners[(i + 1) % corners.size()] - corners[i];
      const double length = edge.norm();
      if (length > 0.0) inside = std::min(inside, 0.5 + sign * cross(edge, p - corners[i]) / length);
    }
    return opacity * inside;
  });
}

}  // namespace saccade
