// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/selection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace saccade {

namespace {

constexpr double kFarthest_px{1e6};
constexpr std::size_t kMostPoints{10'000};
constexpr double kLargestRadius_px{10'000.0};

Error bad_shape(const char* what) { return {Errc::invalid_argument, what, "selection"}; }

bool is_place(const ScreenPoint& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() <= kFarthest_px; }

Status validate_points(std::span<const ScreenPoint> points, std::size_t fewest) {
  if (points.size() < fewest) return bad_shape("a polygon needs three corners, a line one point");
  if (points.size() > kMostPoints) return bad_shape("at most 10000 points make a shape");
  if (!std::all_of(points.begin(), points.end(), is_place)) {
    return bad_shape("coordinates must be finite, and within a million pixels");
  }
  return {};
}

/// Points that bound a shape, and the distance by which it exceeds them.
struct Outline {
  std::vector<ScreenPoint> points;
  double beside_px{0.0};
};

Outline outline(const ScreenRectangle& shape) { return {{shape.corner, shape.opposite}, 0.0}; }
Outline outline(const ScreenPolygon& shape) { return {shape.corners, 0.0}; }
Outline outline(const ScreenStroke& shape) { return {shape.line, shape.radius_px}; }

/// Returns the first pixel whose centre is not before x.
int first_pixel(double x) { return static_cast<int>(std::ceil(x - 0.5)); }

PixelWindow window_of(const Outline& outline, int width, int height) {
  ScreenPoint least = outline.points.front();
  ScreenPoint greatest = least;
  for (const ScreenPoint& p : outline.points) {
    least = least.cwiseMin(p);
    greatest = greatest.cwiseMax(p);
  }
  least.array() -= outline.beside_px;
  greatest.array() += outline.beside_px;
  // One pixel more, because the border of a stroke belongs to the shape.
  return {std::max(0, first_pixel(least.x())), std::max(0, first_pixel(least.y())),
          std::min(width, first_pixel(greatest.x()) + 1), std::min(height, first_pixel(greatest.y()) + 1)};
}

bool is_within(const ScreenPoint& p, const ScreenPoint& a, const ScreenPoint& b, double radius_px) {
  const ScreenPoint along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * along).squaredNorm() <= radius_px * radius_px;
}

struct Interval {
  double least{std::numeric_limits<double>::infinity()};
  double greatest{-std::numeric_limits<double>::infinity()};
  void add(double x) {
    least = std::min(least, x);
    greatest = std::max(greatest, x);
  }
};

/// Returns where the line v meets the surroundings of a segment within the radius, up to rounding.
Interval cut(double v, const ScreenPoint& a, const ScreenPoint& b, double radius_px) {
  Interval cut;
  for (const ScreenPoint& end : {a, b}) {
    const double half2 = radius_px * radius_px - (v - end.y()) * (v - end.y());
    if (half2 < 0.0) continue;
    cut.add(end.x() - std::sqrt(half2));
    cut.add(end.x() + std::sqrt(half2));
  }
  const ScreenPoint along = b - a;
  if (along.squaredNorm() == 0.0) return cut;
  const ScreenPoint across = radius_px / along.norm() * ScreenPoint{-along.y(), along.x()};
  const ScreenPoint corners[]{a + across, b + across, b - across, a - across};
  for (std::size_t i = 0; i < 4; ++i) {
    const ScreenPoint& p = corners[i];
    const ScreenPoint& q = corners[(i + 1) % 4];
    if ((p.y() <= v) != (q.y() <= v)) cut.add(p.x() + (v - p.y()) * (q.x() - p.x()) / (q.y() - p.y()));
  }
  return cut;
}

}  // namespace

Status validate(const ScreenShape& shape) {
  if (const auto* rectangle = std::get_if<ScreenRectangle>(&shape)) {
    return validate_points(outline(*rectangle).points, 2);
  }
  if (const auto* polygon = std::get_if<ScreenPolygon>(&shape)) return validate_points(polygon->corners, 3);
  const ScreenStroke& stroke = std::get<ScreenStroke>(shape);
  if (!(stroke.radius_px > 0.0 && stroke.radius_px <= kLargestRadius_px)) {
    return bad_shape("radius_px must be positive, and at most 10000");
  }
  return validate_points(stroke.line, 1);
}

ScreenMask::ScreenMask(const ScreenShape& shape, int width, int height)
    : window_{std::visit([&](const auto& of) { return window_of(outline(of), width, height); }, shape)} {
  if (window_.empty()) {
    window_ = {};
    return;
  }
  pixels_.assign(static_cast<std::size_t>(window_.width()) * static_cast<std::size_t>(window_.height()), 0);
  std::visit([&](const auto& of) { draw(of); }, shape);
}

void ScreenMask::fill(int v, int first, int end) {
  first = std::max(first, window_.left);
  end = std::min(end, window_.right);
  if (first < end) std::fill_n(pixels_.begin() + static_cast<std::ptrdiff_t>(offset(first, v)), end - first, 1);
}

void ScreenMask::draw(const ScreenRectangle& rectangle) {
  const ScreenPoint least = rectangle.corner.cwiseMin(rectangle.opposite);
  const ScreenPoint greatest = rectangle.corner.cwiseMax(rectangle.opposite);
  const int end = std::min(window_.bottom, first_pixel(greatest.y()));
  for (int v = window_.top; v < end; ++v) fill(v, first_pixel(least.x()), first_pixel(greatest.x()));
}

void ScreenMask::draw(const ScreenPolygon& polygon) {
  // Each line flips all pixels of a row to its right. The row's flips are marked first, then added up.
  for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
    const ScreenPoint& a = polygon.corners[i];
    const ScreenPoint& b = polygon.corners[(i + 1) % polygon.corners.size()];
    const int end = std::min(window_.bottom, first_pixel(std::max(a.y(), b.y())));
    for (int v = std::max(window_.top, first_pixel(std::min(a.y(), b.y()))); v < end; ++v) {
      const double u = a.x() + (v + 0.5 - a.y()) * (b.x() - a.x()) / (b.y() - a.y());
      const int first = std::max(window_.left, first_pixel(u));
      if (first < window_.right) pixels_[offset(first, v)] ^= 1U;
    }
  }
  for (int v = window_.top; v < window_.bottom; ++v) {
    std::uint8_t inside{0};
    for (int u = window_.left; u < window_.right; ++u) {
      std::uint8_t& pixel = pixels_[offset(u, v)];
      inside ^= pixel;
      pixel = inside;
    }
  }
}

void ScreenMask::draw(const ScreenStroke& stroke) {
  for (std::size_t i = 0; i < stroke.line.size(); ++i) {
    draw_segment(stroke.line[i], stroke.line[std::min(i + 1, stroke.line.size() - 1)], stroke.radius_px);
  }
}

void ScreenMask::draw_segment(const ScreenPoint& a, const ScreenPoint& b, double radius_px) {
  const int end = std::min(window_.bottom, first_pixel(std::max(a.y(), b.y()) + radius_px) + 1);
  for (int v = std::max(window_.top, first_pixel(std::min(a.y(), b.y()) - radius_px)); v < end; ++v) {
    const Interval row = cut(v + 0.5, a, b, radius_px);
    if (row.least > row.greatest) continue;
    const auto is_in = [&](int u) { return is_within({u + 0.5, v + 0.5}, a, b, radius_px); };
    // Rounding may have moved a border across a pixel's centre.
    int first = std::max(window_.left, first_pixel(row.least) - 1);
    int last = std::min(window_.right, first_pixel(row.greatest) + 1) - 1;
    while (first <= last && !is_in(first)) ++first;
    while (first <= last && !is_in(last)) --last;
    fill(v, first, last + 1);
  }
}

}  // namespace saccade
