// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/internal/canvas.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <variant>

#include "saccade/report/internal/blend.hpp"
#include "saccade/report/internal/font.hpp"

namespace saccade {
namespace {

constexpr double kNear{0.01};        ///< metres; nothing nearer is drawn
constexpr double kThinnest{0.71};    ///< samples; a thinner line would have gaps
constexpr double kDepthBias{0.002};  ///< relative; lines on a surface win against it

}  // namespace

Canvas::Canvas(const Viewpoint& view, const Rgb8& background, int samples)
    : view_{view},
      T_camera_world_{view.T_world_camera.inverse(Eigen::Isometry)},
      samples_{samples},
      sample_camera_{view.camera.scaled_to_width(samples * view.camera.width)},
      color_{sample_camera_.width, sample_camera_.height, background},
      depth_{sample_camera_.width, sample_camera_.height, kFar} {
  SACCADE_EXPECTS(samples >= 1 && view.camera.validate().ok());
}

void Canvas::plot(int u, int v, float depth, const Rgb8& color) {
  if (u < 0 || v < 0 || u >= color_.width() || v >= color_.height() || !(depth < depth_(u, v))) return;
  depth_(u, v) = depth;
  color_(u, v) = color;
}

std::optional<Canvas::ScreenLine> Canvas::on_screen(const Eigen::Vector3d& a_world, const Eigen::Vector3d& b_world,
                                                    double margin) const {
  Eigen::Vector3d a = T_camera_world_ * a_world;
  Eigen::Vector3d b = T_camera_world_ * b_world;
  if (a.z() < kNear && b.z() < kNear) return std::nullopt;
  if (a.z() < kNear) a += (b - a) * ((kNear - a.z()) / (b.z() - a.z()));
  if (b.z() < kNear) b += (a - b) * ((kNear - b.z()) / (a.z() - b.z()));
  ScreenLine line{sample_camera_.project(a), sample_camera_.project(b), 1.0 / a.z(), 1.0 / b.z(), 0.0, 1.0};
  const Eigen::Vector2d size{color_.width(), color_.height()};
  for (int axis = 0; axis < 2; ++axis) {
    const double d = line.b[axis] - line.a[axis];
    const double lo = -margin - line.a[axis];
    const double hi = size[axis] + margin - line.a[axis];
    if (std::abs(d) < 1e-12) {
      if (lo > 0.0 || hi < 0.0) return std::nullopt;
      continue;
    }
    line.first = std::max(line.first, std::min(lo / d, hi / d));
    line.last = std::min(line.last, std::max(lo / d, hi / d));
  }
  return line.first <= line.last ? std::optional{line} : std::nullopt;
}

void Canvas::blot(const Eigen::Vector2d& at, double inv_z, double radius, const Rgb8& color,
                  std::vector<std::size_t>& hidden) {
  const auto z = static_cast<float>((1.0 - kDepthBias) / inv_z);
  const int v0 = std::max(0, static_cast<int>(std::ceil(at.y() - radius)));
  const int v1 = std::min(color_.height() - 1, static_cast<int>(std::floor(at.y() + radius)));
  for (int v = v0; v <= v1; ++v) {
    const double half = std::sqrt(std::max(0.0, radius * radius - (v - at.y()) * (v - at.y())));
    const int u0 = std::max(0, static_cast<int>(std::ceil(at.x() - half)));
    const int u1 = std::min(color_.width() - 1, static_cast<int>(std::floor(at.x() + half)));
    for (int u = u0; u <= u1; ++u) {
      if (z < depth_(u, v)) {
        depth_(u, v) = z;
        color_(u, v) = color;
      } else if (color_(u, v) != color) {
        hidden.push_back(static_cast<std::size_t>(v) * static_cast<std::size_t>(color_.width()) +
                         static_cast<std::size_t>(u));
      }
    }
  }
}

void Canvas::line(const Eigen::Vector3d& a_world, const Eigen::Vector3d& b_world, const LineStyle& style) {
  const double radius = std::max(kThinnest, style.width_px * samples_ / 2.0);
  const auto line = on_screen(a_world, b_world, radius + 1.0);
  if (!line) return;
  const double length = (line->b - line->a).norm() * (line->last - line->first);
  const int steps = std::max(1, static_cast<int>(std::ceil(length * 1.5)));
  std::vector<std::size_t> hidden;
  for (int i = 0; i <= steps; ++i) {
    const double s = line->first + (line->last - line->first) * i / steps;
    blot(line->a + s * (line->b - line->a), (1.0 - s) * line->inv_z_a + s * line->inv_z_b, radius, style.color, hidden);
  }
  if (style.hidden_opacity <= 0.0) return;
  std::sort(hidden.begin(), hidden.end());
  hidden.erase(std::unique(hidden.begin(), hidden.end()), hidden.end());
  for (const std::size_t i : hidden) {
    Rgb8& sample = color_.data()[i];
    if (sample != style.color) sample = blend(sample, style.color, style.hidden_opacity);
  }
}

void Canvas::point(const Eigen::Vector3d& p_world, double diameter_px, const Rgb8& color, double hidden_opacity) {
  line(p_world, p_world, {color, diameter_px, hidden_opacity});
}

void Canvas::frustum(const PinholeCamera& camera, const Pose& T_world_camera, double depth_m, const LineStyle& style) {
  const auto corner = [&](double u, double v) {
    return Eigen::Vector3d{T_world_camera * (depth_m * camera.ray(u, v))};
  };
  const double right = camera.width - 0.5;
  const double bottom = camera.height - 0.5;
  const std::array<Eigen::Vector3d, 4> corners{corner(-0.5, -0.5), corner(right, -0.5), corner(right, bottom),
                                               corner(-0.5, bottom)};
  for (std::size_t i = 0; i < 4; ++i) {
    line(T_world_camera.translation(), corners[i], style);
    line(corners[i], corners[(i + 1) % 4], style);
  }
  const double middle = (camera.width - 1) / 2.0;
  const Eigen::Vector3d tip = corner(middle, -0.5 - 0.18 * camera.height);
  line(corner(middle - 0.15 * camera.width, -0.5), tip, style);
  line(corner(middle + 0.15 * camera.width, -0.5), tip, style);
}

void Canvas::axes(const Pose& T_world_frame, double length_m, double width_px) {
  constexpr std::array<Rgb8, 3> kColors{{{208, 52, 44}, {56, 150, 60}, {44, 92, 200}}};
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d tip = length_m * Eigen::Vector3d::Unit(axis);
    line(T_world_frame.translation(), T_world_frame * tip, {kColors[static_cast<std::size_t>(axis)], width_px, 0.3});
  }
}

void Canvas::circle(const Eigen::Vector3d& center, const Eigen::Vector3d& x, const Eigen::Vector3d& y,
                    const LineStyle& style) {
  constexpr int kSegments{96};
  const auto at = [&](int i) {
    const double angle = 2.0 * std::numbers::pi * i / kSegments;
    return Eigen::Vector3d{center + std::cos(angle) * x + std::sin(angle) * y};
  };
  for (int i = 0; i < kSegments; ++i) line(at(i), at(i + 1), style);
}

void Canvas::outline(const Region& region, const LineStyle& style) {
  if (const auto* sphere = std::get_if<Sphere>(&region)) {
    const Eigen::Matrix3d axes = sphere->radius_m * Eigen::Matrix3d::Identity();
    for (int i = 0; i < 3; ++i) circle(sphere->center, axes.col(i), axes.col((i + 1) % 3), style);
  } else if (const auto* box = std::get_if<Box>(&region)) {
    const auto corner = [&](int i) {
      return Eigen::Vector3d{(i & 1) != 0 ? box->max.x() : box->min.x(), (i & 2) != 0 ? box->max.y() : box->min.y(),
                             (i & 4) != 0 ? box->max.z() : box->min.z()};
    };
    for (int i = 0; i < 8; ++i) {
      for (const int bit : {1, 2, 4}) {
        if ((i & bit) == 0) line(corner(i), corner(i | bit), style);
      }
    }
  } else if (const auto* cylinder = std::get_if<Cylinder>(&region)) {
    const Eigen::Vector3d axis = (cylinder->top - cylinder->base).normalized();
    const Eigen::Vector3d x = cylinder->radius_m * axis.unitOrthogonal();
    const Eigen::Vector3d y = axis.cross(x);
    circle(cylinder->base, x, y, style);
    circle(cylinder->top, x, y, style);
    for (const Eigen::Vector3d& side : {x, y, Eigen::Vector3d{-x}, Eigen::Vector3d{-y}}) {
      line(cylinder->base + side, cylinder->top + side, style);
    }
  }
}

void Canvas::label(const Eigen::Vector3d& p_world, std::string text, const Rgb8& color, double size_px) {
  if (const auto at = project(p_world)) labels_.push_back({*at, std::move(text), color, size_px});
}

std::optional<Eigen::Vector2d> Canvas::project(const Eigen::Vector3d& p_world) const {
  const Eigen::Vector3d p = T_camera_world_ * p_world;
  if (p.z() < kNear) return std::nullopt;
  return view_.camera.project(p);
}

ColorImage Canvas::finish() const {
  ColorImage picture{view_.camera.width, view_.camera.height};
  const int n = samples_ * samples_;
  for (int v = 0; v < picture.height(); ++v) {
    for (int u = 0; u < picture.width(); ++u) {
      std::array<int, 3> sum{};
      for (int i = 0; i < n; ++i) {
        const Rgb8& sample = color_(u * samples_ + i % samples_, v * samples_ + i / samples_);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += sample[c];
      }
      for (std::size_t c = 0; c < 3; ++c) picture(u, v)[c] = static_cast<std::uint8_t>((sum[c] + n / 2) / n);
    }
  }
  for (const Label& label : labels_) {
    const TextStyle style{label.size_px, label.color, TextAnchor::center};
    // A light rim keeps the text legible on any ground.
    const TextStyle rim{label.size_px, {255, 255, 255}, TextAnchor::center};
    for (int i = 0; i < 8; ++i) {
      const double angle = std::numbers::pi * i / 4.0;
      draw_text(picture, label.at.x() + 1.3 * std::cos(angle), label.at.y() + 1.3 * std::sin(angle), label.text, rim);
    }
    draw_text(picture, label.at.x(), label.at.y(), label.text, style);
  }
  return picture;
}

}  // namespace saccade
