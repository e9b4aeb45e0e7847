// SPDX-License-Identifier: Apache-2.0
// desk_scene: a cluttered desk before a wall with a thin pinboard, as the thesis' third scenario.
#include <Eigen/Geometry>
#include <numbers>

#include "saccade/scene/internal/scene_maker.hpp"

namespace saccade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Face = Patch::Face;

constexpr double kWall_m{0.42};  // y of the wall's front
constexpr Rgb8 kDeskPaper{234, 232, 226};
constexpr Rgb8 kDeskInk{48, 48, 52};
constexpr std::array<Rgb8, 10> kCovers{{{128, 46, 44},
                                        {44, 66, 104},
                                        {58, 88, 66},
                                        {186, 150, 84},
                                        {76, 72, 70},
                                        {206, 200, 186},
                                        {92, 70, 98},
                                        {70, 116, 124},
                                        {172, 94, 56},
                                        {146, 150, 150}}};
constexpr std::array<Rgb8, 5> kNotes{
    {{228, 214, 120}, {224, 168, 178}, {170, 206, 160}, {160, 194, 214}, {230, 196, 130}}};

void add_pinboard(SceneMaker& maker) {
  SceneObject& board = maker.box("pinboard", {0.9, 0.03, 0.55}, {-0.12, kWall_m - 0.09, 0.14}, {186, 152, 110});
  Painter front{board, Face::minus_y};
  constexpr std::array<const char*, 7> kNames{"note-1", "note-2", "note-3", "note-4", "note-5", "note-6", "note-7"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const std::size_t row = i / 4;
    const Vector2d at{-0.36 + 0.085 * static_cast<double>(i % 4) + maker.within(-0.006, 0.006),
                      0.45 - 0.1 * static_cast<double>(row) + maker.within(-0.01, 0.01)};
    front.rectangle(kNames[i], at, {0.072, 0.072}, maker.shade(maker.one_of(kNotes), 0.04));
    front.print(at, {0.055, 0.045}, {84, 86, 110}, 0.011);
  }
  front.rectangle("sheet", {0.07, 0.38}, {0.15, 0.21}, kDeskPaper);
  front.print({0.07, 0.35}, {0.12, 0.13}, kDeskInk, 0.006);
  front.rectangle("sheet-heading", {0.07, 0.455}, {0.11, 0.018}, {60, 86, 122});
  front.rectangle("photo-frame", {0.3, 0.4}, {0.2, 0.15}, {240, 238, 232});
  front.rectangle("photo-sky", {0.3, 0.425}, {0.18, 0.08}, {150, 178, 200});
  front.rectangle("photo-hill", {0.3, 0.365}, {0.18, 0.06}, {98, 116, 82});
  front.ellipse("photo-sun", {0.34, 0.44}, {0.03, 0.03}, {240, 224, 170});
  front.rectangle("calendar", {0.32, 0.2}, {0.16, 0.17}, kDeskPaper);
  front.rectangle("calendar-month", {0.32, 0.265}, {0.16, 0.04}, {158, 56, 52});
  front.text("calendar-title", "MAY", {0.32, 0.265}, 0.028, kDeskPaper);
  front.print({0.32, 0.18}, {0.14, 0.11}, kDeskInk, 0.014);
}

void add_books(SceneMaker& maker) {
  double x_m = -0.72;
  for (int i = 0; i < 9; ++i) {
    const double width_m = maker.within(0.022, 0.05);
    const double height_m = maker.within(0.19, 0.28);
    const std::string name = "book-" + std::to_string(i + 1);
    const Rgb8 color = maker.shade(maker.one_of(kCovers));
    SceneObject& book =
        maker.box(name, {width_m, maker.within(0.14, 0.18), height_m}, {x_m + 0.5 * width_m, 0.2, 0}, color);
    Painter spine{book, Face::minus_y};
    spine.rectangle("title", {0, 0.66 * height_m}, {0.7 * width_m, 0.3 * height_m},
                    i % 3 == 0 ? maker.shade(color, 0.3) : maker.one_of(kCovers));
    if (i % 2 == 0) spine.rectangle("mark", {0, 0.12 * height_m}, {width_m, 0.06 * height_m}, {212, 196, 150});
    x_m += width_m + 0.002;
  }
  double z_m = 0.0;
  for (int i = 0; i < 4; ++i) {
    const double height_m = maker.within(0.02, 0.04);
    const double turn_rad = maker.within(-0.2, 0.2);
    SceneObject& book = maker.box("lying-" + std::to_string(i + 1), {0.17, 0.24 - 0.02 * i, height_m}, {0.62, 0.1, z_m},
                                  maker.shade(maker.one_of(kCovers)), turn_rad);
    Painter{book, Face::minus_y}.rectangle("title", {0, 0.5 * height_m}, {0.1, 0.5 * height_m}, maker.one_of(kCovers));
    if (i == 3) {
      Painter cover{book, Face::plus_z};
      cover.rectangle("field", {0, 0.02}, {0.13, 0.07}, maker.one_of(kCovers));
      cover.text("name", "ROBOT", {0, 0.02}, 0.022, kDeskPaper);
      cover.ellipse("seal", {0, -0.05}, {0.05, 0.05}, maker.one_of(kCovers));
    }
    z_m += height_m;
  }
}

void add_boxes(SceneMaker& maker) {
  SceneObject& carton = maker.box("carton", {0.24, 0.18, 0.15}, {0.42, 0.27, 0}, {178, 142, 102}, 0.12);
  Painter front{carton, Face::minus_y};
  front.rectangle("label", {0.03, 0.08}, {0.1, 0.07}, kDeskPaper);
  front.print({0.03, 0.07}, {0.085, 0.04}, kDeskInk, 0.006);
  front.rectangle("stripe", {-0.08, 0.075}, {0.03, 0.15}, {150, 60, 50});
  Painter{carton, Face::plus_z}.rectangle("tape", {0, 0}, {0.24, 0.05}, {200, 176, 132});
  SceneObject& tea = maker.box("tea", {0.13, 0.07, 0.075}, {0.39, 0.25, 0.15}, {70, 102, 74}, -0.2);
  Painter side{tea, Face::minus_y};
  side.rectangle("label", {0, 0.04}, {0.1, 0.045}, {214, 204, 170});
  side.text("name", "TEA", {0, 0.04}, 0.03, {120, 48, 44});
  Painter{tea, Face::plus_z}.ellipse("seal", {0, 0}, {0.05, 0.05}, {214, 204, 170});
  SceneObject& drawers = maker.box("drawers", {0.2, 0.2, 0.24}, {0.66, 0.3, 0}, {118, 122, 126});
  Painter fronts{drawers, Face::minus_y};
  constexpr std::array<const char*, 4> kDrawers{"drawer-1", "drawer-2", "drawer-3", "drawer-4"};
  constexpr std::array<const char*, 4> kTags{"tag-1", "tag-2", "tag-3", "tag-4"};
  for (std::size_t i = 0; i < kDrawers.size(); ++i) {
    const double at_m = 0.032 + 0.058 * static_cast<double>(i);
    fronts.rectangle(kDrawers[i], {0, at_m}, {0.184, 0.05}, maker.shade(Rgb8{164, 168, 170}, 0.12));
    fronts.rectangle(kTags[i], {0, at_m + 0.004}, {0.06, 0.018}, maker.shade(maker.one_of(kNotes), 0.05));
  }
}

void add_keyboard(SceneMaker& maker) {
  SceneObject& keyboard = maker.box("keyboard", {0.44, 0.15, 0.02}, {-0.12, -0.22, 0}, {60, 62, 64}, 0.06);
  Painter top{keyboard, Face::plus_z};
  constexpr std::array<const char*, 5> kRows{"row-1", "row-2", "row-3", "row-4", "row-5"};
  for (std::size_t i = 0; i < kRows.size(); ++i) {
    top.rectangle(kRows[i], {-0.06, 0.052 - 0.026 * static_cast<double>(i)}, {0.29, 0.02},
                  i == 0 ? Rgb8{120, 122, 124} : Rgb8{188, 188, 184});
  }
  top.rectangle("number-pad", {0.165, -0.013}, {0.085, 0.098}, {182, 182, 178});
  top.rectangle("enter", {0.197, -0.04}, {0.02, 0.045}, {172, 96, 60});
  maker.add("mouse", SuperquadricShape{{0.03, 0.052, 0.018}, 0.8, 0.7},
            Pose{Eigen::Translation3d{0.2, -0.2, 0.0} * Eigen::AngleAxisd{-0.2, Vector3d::UnitZ()}}, {72, 74, 78});
  const std::array<Vector3d, 6> mouse_cable{{{0.19, -0.15, 0.004},
                                             {0.18, -0.08, 0.004},
                                             {0.12, -0.03, 0.004},
                                             {0.13, 0.06, 0.004},
                                             {0.08, 0.14, 0.004},
                                             {0.09, 0.3, 0.004}}};
  maker.cable("mouse-cable", mouse_cable, 0.004, {40, 40, 42});
  const std::array<Vector3d, 6> charger{{{-0.5, -0.3, 0.004},
                                         {-0.42, -0.24, 0.004},
                                         {-0.46, -0.12, 0.004},
                                         {-0.38, -0.04, 0.004},
                                         {-0.28, 0.0, 0.004},
                                         {-0.24, 0.12, 0.004}}};
  maker.cable("charger-cable", charger, 0.004, {214, 212, 206});
  SceneObject& phone = maker.box("phone", {0.075, 0.15, 0.009}, {-0.53, -0.21, 0}, {54, 56, 60}, 0.5);
  Painter screen{phone, Face::plus_z};
  screen.rectangle("screen", {0, 0.003}, {0.066, 0.118}, {84, 112, 138});
  screen.rectangle("message", {0, 0.02}, {0.056, 0.03}, {206, 210, 212});
}

void add_vessels(SceneMaker& maker) {
  RevolutionShape body{{{0.036, 0.0}, {0.041, 0.02}, {0.042, 0.06}, {0.042, 0.095}}, 0.004};
  SceneObject& mug = maker.add(
      "mug", JugShape{body, 0.022, 0.078, 0.026, 0.0055},
      Pose{Eigen::Translation3d{0.36, -0.06, 0.0} * Eigen::AngleAxisd{-0.7, Vector3d::UnitZ()}}, {214, 208, 192});
  mug.segment = "mug";
  for (const Face face : {Face::minus_y, Face::minus_x}) {
    Painter{mug, face}.rectangle("band", {0, 0.05}, {0.09, 0.03}, {64, 92, 120});
  }
  maker.add("pencil-cup", RevolutionShape{{{0.036, 0.0}, {0.036, 0.1}}, 0.003},
            Pose{Eigen::Translation3d{-0.22, 0.12, 0.0}}, {92, 96, 100});
  constexpr std::array<Rgb8, 5> kPens{{{196, 150, 60}, {168, 50, 46}, {46, 80, 136}, {56, 104, 70}, {58, 58, 60}}};
  for (std::size_t i = 0; i < kPens.size(); ++i) {
    const double around_rad = 1.26 * static_cast<double>(i) + 0.4;
    const Vector3d lean{std::cos(around_rad), std::sin(around_rad), 0.0};
    const Vector3d foot = Vector3d{-0.22, 0.12, 0.008} - 0.02 * lean;
    const Vector3d top = foot + 0.045 * lean + Vector3d{0, 0, 0.15};
    const std::string pen = "pen-" + std::to_string(i + 1);
    maker.rod(pen, foot, foot + 0.85 * (top - foot), 0.0055, kPens[i]);
    maker.rod(pen + "/cap", foot + 0.85 * (top - foot), top, 0.006, maker.shade(kPens[i], 0.4));
  }
  maker.add("pot", ConeShape{0.04, 0.055, 0.09}, Pose{Eigen::Translation3d{0.2, 0.2, 0.0}}, {172, 104, 74});
  maker.add("pot/earth", CylinderShape{0.048, 0.004}, Pose{Eigen::Translation3d{0.2, 0.2, 0.09}}, {74, 58, 46});
  for (int i = 0; i < 7; ++i) {
    const double around_rad = 0.9 * i;
    const Vector3d at{0.2 + 0.035 * std::cos(around_rad), 0.2 + 0.035 * std::sin(around_rad), 0.085 + 0.012 * i};
    SceneObject& leaf =
        maker.add("leaf-" + std::to_string(i), SuperquadricShape{{0.03, 0.016, 0.024}, 1.0, 1.0},
                  Pose{Eigen::Translation3d{at} * Eigen::AngleAxisd{around_rad, Vector3d::UnitZ()}}, {78, 112, 62});
    leaf.segment = "plant";
  }
}

void add_small_things(SceneMaker& maker) {
  SceneObject& sheet = maker.box("sheet", {0.21, 0.29, 0.002}, {-0.4, -0.02, 0}, kDeskPaper, 0.25);
  Painter paper{sheet, Face::plus_z};
  paper.text("heading", "PLAN", {-0.03, 0.11}, 0.026, {58, 76, 116});
  paper.print({0, 0.03}, {0.16, 0.09}, kDeskInk, 0.006);
  paper.rectangle("sketch", {0.0, -0.08}, {0.14, 0.08}, {202, 210, 214});
  paper.ellipse("sketch-disc", {-0.03, -0.08}, {0.05, 0.05}, {166, 84, 70});
  paper.ellipse("sketch-ring", {0.035, -0.08}, {0.04, 0.04}, {112, 142, 160});
  SceneObject& notebook = maker.box("notebook", {0.15, 0.21, 0.014}, {0.52, -0.18, 0}, {58, 66, 84}, -0.3);
  Painter cover{notebook, Face::plus_z};
  cover.rectangle("strap", {0.055, 0}, {0.012, 0.21}, {132, 52, 50});
  cover.rectangle("label", {-0.01, 0.05}, {0.08, 0.04}, {214, 206, 184});
  SceneObject& calculator = maker.box("calculator", {0.08, 0.14, 0.015}, {0.32, -0.25, 0}, {98, 102, 106}, 0.15);
  Painter keys{calculator, Face::plus_z};
  keys.rectangle("display", {0, 0.047}, {0.064, 0.026}, {158, 170, 148});
  constexpr std::array<const char*, 9> kKeys{"key-1", "key-2", "key-3", "key-4", "key-5",
                                             "key-6", "key-7", "key-8", "key-9"};
  for (std::size_t i = 0; i < kKeys.size(); ++i) {
    const std::size_t row = i / 3;
    keys.rectangle(kKeys[i], {-0.024 + 0.024 * static_cast<double>(i % 3), 0.012 - 0.026 * static_cast<double>(row)},
                   {0.018, 0.018}, i == 8 ? Rgb8{178, 92, 56} : Rgb8{206, 206, 200});
  }
  SceneObject& cube = maker.box("cube", {0.057, 0.057, 0.057}, {0.04, -0.04, 0}, {36, 36, 38}, 0.6);
  constexpr std::array<Rgb8, 6> kStickers{
      {{206, 204, 196}, {196, 168, 56}, {170, 48, 44}, {188, 100, 48}, {48, 88, 144}, {58, 116, 74}}};
  for (const auto& [face, side] :
       {std::pair{Face::plus_z, "top-"}, std::pair{Face::minus_y, "front-"}, std::pair{Face::minus_x, "side-"}}) {
    Painter stickers{cube, face};
    for (int i = 0; i < 9; ++i) {
      const int row = i / 3 - 1;
      const double up_m = 0.019 * row + (face == Face::plus_z ? 0.0 : 0.0285);
      stickers.rectangle((side + std::to_string(i + 1)).c_str(), {0.019 * (i % 3 - 1), up_m}, {0.0165, 0.0165},
                         maker.one_of(kStickers));
    }
  }
  maker.box("stapler/base", {0.14, 0.034, 0.012}, {-0.1, -0.08, 0}, {62, 64, 66}, 0.9);
  maker.box("stapler/arm", {0.125, 0.03, 0.028}, {-0.1, -0.08, 0.012}, {142, 50, 48}, 0.9);
  maker.box("eraser/sleeve", {0.035, 0.022, 0.013}, {0.14, -0.1, 0}, {58, 90, 140}, 0.3);
  maker.box("eraser", {0.056, 0.02, 0.012}, {0.14, -0.1, 0}, {232, 230, 226}, 0.3);
  const Vector3d ruler{-0.1, -0.34, 0};
  SceneObject& scale = maker.box("ruler", {0.3, 0.032, 0.003}, ruler, {196, 172, 120}, -0.05);
  Painter{scale, Face::plus_z}.rectangle("edge", {0, 0.012}, {0.3, 0.007}, {110, 92, 66});
}

}  // namespace

SurfelScene desk_scene(std::string_view name, std::size_t frames, std::uint64_t seed) {
  SceneMaker maker{name, seed};
  maker.box("wall", {30.0, 0.1, 4.0}, {0.0, kWall_m + 0.05, -0.75}, {212, 212, 206});
  maker.box("floor", {30.0, 30.0, 0.1}, {0.0, kWall_m - 15.0, -0.85}, {112, 104, 96});
  maker.box("desk", {1.6, 0.82, 0.035}, {0.0, 0.0, -0.035}, {176, 152, 120});
  add_pinboard(maker);
  add_books(maker);
  add_boxes(maker);
  add_keyboard(maker);
  add_vessels(maker);
  add_small_things(maker);
  SurfelScene made{std::move(maker.scene()), {}, frames, {}, {}};
  made.scene.workspace = Box{{-0.82, -0.45, -0.08}, {0.82, 0.45, 0.8}};
  made.path.targets = Box{{-0.55, -0.15, 0.0}, {0.55, 0.25, 0.4}};
  made.path.azimuth_from_rad = -0.5 * std::numbers::pi - 0.7;
  made.path.azimuth_to_rad = -0.5 * std::numbers::pi + 0.7;
  made.path.elevation_from_rad = 0.25;
  made.path.elevation_to_rad = 0.95;
  made.path.distance_from_m = 1.05;  // keeps objects in front from being too near for an Xtion
  made.path.distance_to_m = 1.55;
  return made;
}

}  // namespace saccade
