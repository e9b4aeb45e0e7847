// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/internal/scene_maker.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace saccade {

using Eigen::Vector2d;
using Eigen::Vector3d;

Rgb8 SceneMaker::one_of(std::span<const Rgb8> colors) {
  SACCADE_EXPECTS(colors.size() > 1);
  Rgb8 color = colors[below(colors.size())];
  while (color == last_) color = colors[below(colors.size())];
  return last_ = color;
}

Rgb8 SceneMaker::shade(const Rgb8& color, double spread) {
  const double factor = within(1.0 - spread, 1.0 + spread);
  Rgb8 shaded{};
  for (std::size_t k = 0; k < 3; ++k) {
    shaded[k] = static_cast<std::uint8_t>(std::clamp(std::lround(factor * color[k]), 0L, 255L));
  }
  return shaded;
}

SceneObject& SceneMaker::add(const std::string& name, Shape shape, const Pose& T_world_object, const Rgb8& color) {
  SceneObject object;
  object.name = name;
  object.shape = std::move(shape);
  object.T_world_object = T_world_object;
  object.color = color;
  return scene_.objects.emplace_back(std::move(object));
}

SceneObject& SceneMaker::box(const std::string& name, const Vector3d& size_m, const Vector3d& at, const Rgb8& color,
                             double turn_rad) {
  const Pose T_world_box{Eigen::Translation3d{at} * Eigen::AngleAxisd{turn_rad, Vector3d::UnitZ()}};
  return add(name, BoxShape{size_m}, T_world_box, color);
}

SceneObject& SceneMaker::rod(const std::string& name, const Vector3d& from, const Vector3d& to, double radius_m,
                             const Rgb8& color) {
  const Vector3d along = to - from;
  const Pose T_world_rod{Eigen::Translation3d{from} * Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), along)};
  return add(name, CylinderShape{radius_m, along.norm()}, T_world_rod, color);
}

void SceneMaker::cable(const std::string& name, std::span<const Vector3d> points, double radius_m, const Rgb8& color) {
  constexpr int kRodsPerStretch{6};
  Vector3d from = points.front();
  std::size_t rods = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    // Catmull–Rom spline, which passes through the points.
    const Vector3d& a = points[i > 0 ? i - 1 : i];
    const Vector3d& b = points[i];
    const Vector3d& c = points[i + 1];
    const Vector3d& d = points[std::min(i + 2, points.size() - 1)];
    for (int k = 1; k <= kRodsPerStretch; ++k) {
      const double s = static_cast<double>(k) / kRodsPerStretch;
      const Vector3d to = b + 0.5 * s * (c - a + s * (2.0 * a - 5.0 * b + 4.0 * c - d + s * (3.0 * (b - c) + d - a)));
      const std::string part = name + "-" + std::to_string(++rods);
      rod(part, from, to, radius_m, color).segment = name;
      const Pose T_world_joint{Eigen::Translation3d{to - radius_m * Vector3d::UnitZ()}};
      add(part + "-joint", SphereShape{radius_m}, T_world_joint, color).segment = name;
      from = to;
    }
  }
}

Patch& Painter::put(Patch::Kind kind, const std::string& part, const Vector2d& center_m, const Vector2d& size_m,
                    const Rgb8& color) {
  Patch& patch = object_.patches.emplace_back();
  patch.face = face_;
  patch.kind = kind;
  patch.center_m = center_m;
  patch.size_m = size_m;
  patch.color = color;
  patch.segment = object_.name + "/" + part;
  return patch;
}

void Painter::print(const Vector2d& center_m, const Vector2d& size_m, const Rgb8& color, double line_m) {
  put(Patch::Kind::print, "", center_m, size_m, color).line_m = line_m;
}

void Painter::text(const char* part, std::string_view letters, const Vector2d& center_m, double height_m,
                   const Rgb8& color) {
  const double width_m = 5.0 / 7.0 * height_m;
  const double pitch_m = 6.2 / 7.0 * height_m;
  const double first_m = center_m.x() - 0.5 * pitch_m * (static_cast<double>(letters.size()) - 1.0);
  for (std::size_t i = 0; i < letters.size(); ++i) {
    put(Patch::Kind::glyph, std::string{part} + "-" + std::to_string(i + 1),
        {first_m + pitch_m * static_cast<double>(i), center_m.y()}, {width_m, height_m}, color)
        .glyph = letters[i];
  }
}

}  // namespace saccade
