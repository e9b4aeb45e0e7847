// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/depth_raster.hpp"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRounding_px{1e-7};  ///< keeps pixels from falling between two triangles that share an edge

/// Returns the distance from the line a → b, positive on the side of c; positive everywhere if a and b coincide.
std::array<double, 3> edge_distance(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const double length = (b - a).norm();
  if (!(length > 1e-9)) return {0.0, 0.0, 1e9};
  Vector2d normal{-(b - a).y() / length, (b - a).x() / length};
  if (normal.dot(c - a) < 0.0) normal = -normal;
  return {normal.x(), normal.y(), -normal.dot(a)};
}

}  // namespace

void DepthRaster::add(const Triangle& p_camera, bool at_rim) {
  const Vector3d normal = (p_camera[1] - p_camera[0]).cross(p_camera[2] - p_camera[0]);
  const double size = normal.norm();
  const double offset = normal.dot(p_camera[0]);
  if (!(std::fabs(offset) > 1e-9 * size)) return;  // seen edge-on: covers no pixel, and its neighbours grow
  // n·(z·ray) = offset; the margin moves the plane towards the camera, at most up to it.
  const double moved = std::copysign(std::max(std::fabs(offset) - growth_.margin_m * size, 1e-9 * size), offset);
  Plane plane;
  plane.inverse_depth.a = normal.x() / camera_.fx / moved;
  plane.inverse_depth.b = normal.y() / camera_.fy / moved;
  plane.inverse_depth.c = normal.z() / moved - plane.inverse_depth.a * camera_.cx - plane.inverse_depth.b * camera_.cy;
  plane.offset_m = growth_.margin_m;

  std::array<Vector3d, 4> kept;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d& p = p_camera[i];
    const Vector3d& next = p_camera[(i + 1) % 3];
    if (p.z() >= kNearest_m) kept[count++] = p;
    if ((p.z() >= kNearest_m) != (next.z() >= kNearest_m)) {
      kept[count] = p + (next - p) * ((kNearest_m - p.z()) / (next.z() - p.z()));
      kept[count++].z() = kNearest_m;
    }
  }
  for (std::size_t i = 2; i < count; ++i) add_clipped({kept[0], kept[i - 1], kept[i]}, plane, at_rim);
}

void DepthRaster::add_clipped(const Triangle& p_camera, const Plane& plane, bool at_rim) {
  std::array<Vector2d, 3> at;
  for (std::size_t i = 0; i < 3; ++i) at[i] = camera_.project(p_camera[i]);
  Projected t;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [a, b, c] = edge_distance(at[i], at[(i + 1) % 3], at[(i + 2) % 3]);
    t.edges[i] = {a, b, c};
  }
  const double nearest_m = std::min({p_camera[0].z(), p_camera[1].z(), p_camera[2].z()});
  const double farthest_m = std::max({p_camera[0].z(), p_camera[1].z(), p_camera[2].z()});
  t.inverse_depth = plane.inverse_depth;
  t.nearest = 1.0 / std::max(nearest_m - plane.offset_m, kNearest_m);
  t.farthest = 1.0 / farthest_m;
  t.grown_px = 0.0;
  if (at_rim) {
    t.grown_px =
        std::min(growth_.most_px, growth_.border_px + growth_.margin_m * std::max(camera_.fx, camera_.fy) / nearest_m);
  }
  const double beside = t.grown_px + kRounding_px;
  t.left = std::max(0.0, std::min({at[0].x(), at[1].x(), at[2].x()}) - beside);
  t.right = std::min(camera_.width - 1.0, std::max({at[0].x(), at[1].x(), at[2].x()}) + beside);
  t.top = std::max(0.0, std::min({at[0].y(), at[1].y(), at[2].y()}) - beside);
  t.bottom = std::min(camera_.height - 1.0, std::max({at[0].y(), at[1].y(), at[2].y()}) + beside);
  if (std::ceil(t.left) <= t.right && std::ceil(t.top) <= t.bottom) triangles_.push_back(t);
}

void DepthRaster::draw_rows(int begin, int end, float* inverse_depth) const {
  for (const Projected& t : triangles_) {
    const int first = std::max(begin, static_cast<int>(std::ceil(t.top)));
    const int last = std::min(end - 1, static_cast<int>(std::floor(t.bottom)));
    for (int v = first; v <= last; ++v)
      draw_row(t, v, inverse_depth + static_cast<std::ptrdiff_t>(v - begin) * camera_.width);
  }
}

void DepthRaster::draw_row(const Projected& t, int v, float* row) const {
  const Span inside = span(t, v, 0.0);
  if (t.grown_px <= 0.0) {
    draw_inside(t, v, inside, row);
    return;
  }
  const Span grown = span(t, v, t.grown_px);
  if (inside.first > inside.last) {
    draw_grown(t, v, grown, row);
    return;
  }
  draw_grown(t, v, {grown.first, inside.first - 1}, row);
  draw_inside(t, v, inside, row);
  draw_grown(t, v, {inside.last + 1, grown.last}, row);
}

DepthRaster::Span DepthRaster::span(const Projected& t, int v, double beside_px) {
  double left = t.left;
  double right = t.right;
  for (const Linear& edge : t.edges) {
    const double here = edge.b * v + edge.c + beside_px + kRounding_px;
    if (edge.a > 1e-12) {
      left = std::max(left, -here / edge.a);
    } else if (edge.a < -1e-12) {
      right = std::min(right, -here / edge.a);
    } else if (here < 0.0) {
      return {};
    }
  }
  if (!(left <= right)) return {};
  return {static_cast<int>(std::ceil(left)), static_cast<int>(std::floor(right))};
}

// Single precision from a span's first pixel on suffices: within a triangle nothing changes by more than its own size.

void DepthRaster::draw_inside(const Projected& t, int v, const Span& span, float* row) {
  const int count = span.last - span.first + 1;
  const auto w0 = static_cast<float>(t.inverse_depth.at(span.first, v));
  const auto dw = static_cast<float>(t.inverse_depth.a);
  const auto farthest = static_cast<float>(t.farthest);
  const auto nearest = static_cast<float>(t.nearest);
  float* out = row + span.first;
  for (int i = 0; i < count; ++i) {
    const float w = std::min(std::max(w0 + dw * static_cast<float>(i), farthest), nearest);
    out[i] = std::max(out[i], w);
  }
}

void DepthRaster::draw_grown(const Projected& t, int v, const Span& span, float* row) const {
  const int count = span.last - span.first + 1;
  const auto w0 = static_cast<float>(t.inverse_depth.at(span.first, v));
  const auto dw = static_cast<float>(t.inverse_depth.a);
  const auto farthest = static_cast<float>(t.farthest);
  const auto nearest = static_cast<float>(t.nearest);
  const auto border = static_cast<float>(growth_.border_px + kRounding_px);
  const auto per_w = static_cast<float>(growth_.margin_m * std::max(camera_.fx, camera_.fy));
  const auto most = static_cast<float>(t.grown_px + kRounding_px);
  std::array<float, 3> e0;
  std::array<float, 3> de;
  for (std::size_t k = 0; k < 3; ++k) {
    e0[k] = static_cast<float>(t.edges[k].at(span.first, v));
    de[k] = static_cast<float>(t.edges[k].a);
  }
  float* out = row + span.first;
  for (int i = 0; i < count; ++i) {
    const auto x = static_cast<float>(i);
    const float w = std::min(std::max(w0 + dw * x, farthest), nearest);
    const float grown = std::min(most, border + per_w * w);
    const float inside = std::min(std::min(e0[0] + de[0] * x, e0[1] + de[1] * x), e0[2] + de[2] * x) + grown;
    out[i] = std::max(out[i], inside >= 0.0F ? w : 0.0F);
  }
}

}  // namespace saccade
