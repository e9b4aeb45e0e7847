// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/surfel_scenes.hpp"

#include <Eigen/Geometry>
#include <numbers>
#include <random>

namespace saccade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::array<Rgb8, 8> kInks{{{190, 40, 40},
                                     {35, 80, 165},
                                     {30, 120, 60},
                                     {225, 180, 40},
                                     {110, 50, 130},
                                     {30, 140, 150},
                                     {215, 110, 40},
                                     {45, 45, 50}}};
constexpr Rgb8 kSteel{165, 168, 172};

class SceneMaker {
 public:
  SceneMaker(std::string_view name, std::uint64_t seed) : engine_{seed} { scene_.name = name; }
  double within(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11U) * 0x1.0p-53);
  }
  const Rgb8& ink() { return kInks[last_ = (last_ + 1 + engine_() % 6) % kInks.size()]; }  // never the last one again

  SceneObject& add(const std::string& name, Shape shape, const Pose& T_world_object, const Rgb8& color) {
    SceneObject object;
    object.name = name;
    object.shape = std::move(shape);
    object.T_world_object = T_world_object;
    object.color = color;
    return scene_.objects.emplace_back(std::move(object));
  }
  SceneObject& box(const std::string& name, const Vector3d& size_m, const Vector3d& at, const Rgb8& color) {
    return add(name, BoxShape{size_m}, Pose{Eigen::Translation3d{at}}, color);
  }
  Scene& scene() { return scene_; }

 private:
  std::mt19937_64 engine_;
  std::size_t last_{0};
  Scene scene_;
};

Patch patch(Patch::Face face, Patch::Kind kind, const Vector2d& center_m, const Vector2d& size_m, const Rgb8& color,
            std::string segment) {
  Patch made;
  made.face = face;
  made.kind = kind;
  made.center_m = center_m;
  made.size_m = size_m;
  made.color = color;
  made.segment = std::move(segment);
  return made;
}

/// A cover with a masthead of letters, pictures with a disc on each, and paragraphs of print.
void add_magazine(SceneMaker& maker, const std::string& name, const Vector3d& at, double turn_rad) {
  constexpr Vector2d::Scalar kWidth_m{0.21};
  constexpr double kHeight_m{0.28};
  const Pose T = Pose{Eigen::Translation3d{at} * Eigen::AngleAxisd{turn_rad, Vector3d::UnitZ()}};
  SceneObject& page = maker.add(name, BoxShape{{kWidth_m, kHeight_m, 0.006}}, T, {232, 230, 224});
  const auto put = [&](Patch::Kind kind, const Vector2d& center_m, const Vector2d& size_m, const Rgb8& color,
                       const std::string& part) -> Patch& {
    return page.patches.emplace_back(patch(Patch::Face::plus_z, kind, center_m, size_m, color, name + "/" + part));
  };
  put(Patch::Kind::rectangle, {0.0, 0.105}, {0.19, 0.055}, maker.ink(), "masthead");
  constexpr std::string_view kTitle{"NEXT"};
  for (std::size_t i = 0; i < kTitle.size(); ++i) {
    put(Patch::Kind::glyph, {-0.066 + 0.044 * static_cast<double>(i), 0.105}, {0.03, 0.042}, {240, 238, 230},
        "letter-" + std::to_string(i + 1))
        .glyph = kTitle[i];
  }
  for (int i = 0; i < 3; ++i) {
    const double x_m = -0.068 + 0.068 * i;
    put(Patch::Kind::rectangle, {x_m, 0.03}, {0.06, 0.07}, maker.ink(), "picture-" + std::to_string(i + 1));
    put(Patch::Kind::ellipse, {x_m, 0.025}, {0.034, 0.034}, maker.ink(), "disc-" + std::to_string(i + 1));
  }
  put(Patch::Kind::rectangle, {-0.05, -0.07}, {0.09, 0.10}, maker.ink(), "column");
  put(Patch::Kind::print, {0.05, -0.07}, {0.09, 0.10}, {60, 60, 64}, "");
}

SurfelScene magazines(std::string_view name, int columns, int rows, std::size_t frames, std::uint64_t seed) {
  SceneMaker maker{name, seed};
  const Vector2d half_m{0.16 * columns + 0.08, 0.19 * rows + 0.06};
  maker.box("floor", {6.0, 6.0, 0.1}, {0.0, 0.0, -0.85}, {120, 116, 110});
  maker.box("table", {2.0 * half_m.x(), 2.0 * half_m.y(), 0.04}, {0.0, 0.0, -0.04}, {150, 152, 155});
  for (int i = 0; i < columns * rows; ++i) {
    const int row = i / columns;
    const Vector3d at{0.32 * (i % columns - 0.5 * (columns - 1)) + maker.within(-0.01, 0.01),
                      0.38 * (row - 0.5 * (rows - 1)) + maker.within(-0.01, 0.01), 0.0};
    add_magazine(maker, "magazine-" + std::to_string(i + 1), at, maker.within(-0.12, 0.12));
  }
  SurfelScene made{std::move(maker.scene()), {}, frames};
  made.scene.workspace = Box{{-half_m.x(), -half_m.y(), -0.05}, {half_m.x(), half_m.y(), 0.4}};
  made.path.targets = Box{{-0.8 * half_m.x(), -0.6 * half_m.y(), 0.0}, {0.8 * half_m.x(), 0.6 * half_m.y(), 0.0}};
  made.path.azimuth_from_rad = -2.6;
  made.path.azimuth_to_rad = -0.5;
  made.path.elevation_from_rad = 0.7;
  made.path.elevation_to_rad = 1.25;
  return made;
}

/// A tool that hangs on a panel: a grip, a ring around it, and a shaft.
void add_tool(SceneMaker& maker, const std::string& name, const Vector3d& at, double length_m, double radius_m) {
  const auto part = [&](const char* what, double radius, double from_m, double to_m, const Rgb8& color) {
    maker.add(name + "/" + what, CylinderShape{radius, to_m - from_m},
              Pose{Eigen::Translation3d{at + from_m * Vector3d::UnitZ()}}, color);
  };
  part("shaft", 0.45 * radius_m, 0.0, 0.5 * length_m, kSteel);
  part("grip", radius_m, 0.5 * length_m, 0.88 * length_m, maker.ink());
  part("ring", 1.05 * radius_m, 0.88 * length_m, length_m, maker.ink());
}

/// Thin panels with a gap between them, before a wall; tools on them, and a sign.
SurfelScene workshop(std::string_view name, int panels, int rows, int per_row, std::size_t frames, std::uint64_t seed) {
  constexpr double kPanelWidth_m{0.9};
  constexpr double kThickness_m{0.03};
  constexpr double kGap_m{0.06};
  SceneMaker maker{name, seed};
  const double half_m = 0.5 * panels * (kPanelWidth_m + kGap_m);
  const double height_m = 0.3 * rows + 0.1;
  maker.box("wall", {6.0, 0.1, 4.0}, {0.0, 0.2, -1.5}, {222, 222, 216});
  for (int k = 0; k < panels; ++k) {
    const std::string panel = "panel-" + std::to_string(k + 1);
    const double x_m = (k - 0.5 * (panels - 1)) * (kPanelWidth_m + kGap_m);
    SceneObject& board = maker.box(panel, {kPanelWidth_m, kThickness_m, height_m}, {x_m, 0.0, 0.0}, {196, 160, 112});
    board.patches.push_back(patch(Patch::Face::minus_y, Patch::Kind::rectangle, {0.0, height_m - 0.04}, {0.3, 0.05},
                                  {240, 236, 220}, panel + "/sign"));
    board.patches.push_back(patch(Patch::Face::minus_y, Patch::Kind::glyph, {0.0, height_m - 0.04}, {0.026, 0.04},
                                  {30, 30, 34}, panel + "/number"));
    board.patches.back().glyph = static_cast<char>('1' + k);
    for (int i = 0; i < rows * per_row; ++i) {
      const int row = i / per_row;
      const double radius_m = maker.within(0.011, 0.019);
      const Vector3d at{x_m + kPanelWidth_m * ((i % per_row + 0.5) / per_row - 0.5),
                        -0.5 * kThickness_m - 1.2 * radius_m, 0.04 + 0.29 * row};
      add_tool(maker, panel + "/tool-" + std::to_string(i + 1), at, maker.within(0.16, 0.24), radius_m);
    }
  }
  SurfelScene made{std::move(maker.scene()), {}, frames};
  made.scene.workspace = Box{{-half_m, -0.3, -0.1}, {half_m, 0.2, height_m + 0.1}};
  made.path.targets = Box{{-0.8 * half_m, 0.0, 0.2 * height_m}, {0.8 * half_m, 0.0, 0.8 * height_m}};
  made.path.azimuth_from_rad = -0.5 * std::numbers::pi - 0.5;
  made.path.azimuth_to_rad = -0.5 * std::numbers::pi + 0.5;
  made.path.elevation_from_rad = -0.2;
  made.path.elevation_to_rad = 0.35;
  return made;
}

}  // namespace

Result<SurfelScene> surfel_scene(std::string_view name) {
  if (name == "workshop-1") return workshop(name, 2, 2, 7, 1737, 1);
  if (name == "workshop-2") return workshop(name, 2, 4, 8, 1737, 2);
  if (name == "magazines-1") return magazines(name, 5, 2, 1831, 3);
  if (name == "magazines-2") return magazines(name, 4, 2, 1698, 4);
  std::string known;
  for (const std::string_view scene : kSurfelScenes) known += (known.empty() ? "" : ", ") + std::string{scene};
  return Error{Errc::not_found, "no such scene for surfels; there are " + known, std::string{name}};
}

}  // namespace saccade
