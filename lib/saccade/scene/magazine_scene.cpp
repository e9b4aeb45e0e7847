// SPDX-License-Identifier: Apache-2.0
// magazine_scene: covers, articles and advertisements on a grey table, as the thesis' fourth and fifth scenario.
#include <Eigen/Geometry>
#include <numbers>

#include "saccade/scene/internal/scene_maker.hpp"

namespace saccade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPageWidth_m{0.21};
constexpr double kPageHeight_m{0.28};
constexpr Rgb8 kPrintInk{46, 46, 50};
constexpr Rgb8 kPrintWhite{240, 239, 235};

/// Muted colours, as in print; some are similar.
constexpr std::array<Rgb8, 12> kPrints{{{172, 48, 44},
                                        {52, 84, 132},
                                        {66, 108, 78},
                                        {206, 168, 70},
                                        {96, 66, 104},
                                        {70, 128, 136},
                                        {194, 112, 62},
                                        {62, 64, 70},
                                        {132, 138, 142},
                                        {118, 150, 172},
                                        {166, 138, 108},
                                        {142, 56, 62}}};
constexpr std::array<Rgb8, 5> kPapers{
    {{236, 234, 228}, {228, 222, 208}, {240, 238, 234}, {222, 224, 222}, {232, 228, 214}}};
constexpr std::array<std::string_view, 10> kTitles{"NEXT", "GARDEN", "MOTOR", "SKY",   "HOUSE",
                                                   "COOK", "SPORT",  "RADIO", "TREND", "ALPS"};

/// Paints earth below, sky above, and something round.
void landscape(SceneMaker& maker, Painter& page, const Vector2d& center, const Vector2d& size) {
  constexpr std::array<Rgb8, 3> kSkies{{{150, 182, 206}, {196, 206, 210}, {222, 172, 128}}};
  constexpr std::array<Rgb8, 3> kGrounds{{{104, 122, 76}, {182, 160, 118}, {84, 104, 112}}};
  const Rgb8 ground = maker.one_of(kGrounds);
  page.rectangle("sky", center, size, maker.shade(maker.one_of(kSkies)));
  page.ellipse("sun", center + 0.22 * size, {0.26 * size.y(), 0.26 * size.y()}, {240, 226, 172});
  page.rectangle("far", center - Vector2d{0, 0.2 * size.y()}, {size.x(), 0.22 * size.y()}, maker.shade(ground, 0.3));
  page.rectangle("ground", center - Vector2d{0, 0.38 * size.y()}, {size.x(), 0.24 * size.y()}, ground);
}

void portrait(SceneMaker& maker, Painter& page, const Vector2d& center, const Vector2d& size) {
  constexpr std::array<Rgb8, 3> kSkins{{{222, 180, 150}, {190, 142, 110}, {120, 84, 64}}};
  constexpr std::array<Rgb8, 3> kHairs{{{64, 46, 36}, {176, 132, 78}, {42, 40, 42}}};
  page.rectangle("background", center, size, maker.shade(maker.one_of(kPrints)));
  const double h = std::min(size.x(), size.y());
  page.rectangle("jacket", center - Vector2d{0, 0.5 * size.y() - 0.14 * h}, {0.62 * h, 0.28 * h},
                 maker.one_of(kPrints));
  page.ellipse("hair", center + Vector2d{0, 0.13 * h}, {0.46 * h, 0.56 * h}, maker.one_of(kHairs));
  page.ellipse("face", center + Vector2d{0, 0.05 * h}, {0.34 * h, 0.46 * h}, maker.one_of(kSkins));
}

void dish(SceneMaker& maker, Painter& page, const Vector2d& center, const Vector2d& size) {
  const double h = std::min(size.x(), size.y());
  page.rectangle("cloth", center, size, maker.one_of(kPrints));
  page.ellipse("plate", center, {0.82 * h, 0.82 * h}, {234, 232, 226});
  page.ellipse("food", center - Vector2d{0.08 * h, 0.02 * h}, {0.42 * h, 0.36 * h}, maker.one_of(kPrints));
  page.ellipse("herb", center + Vector2d{0.16 * h, 0.12 * h}, {0.2 * h, 0.16 * h}, {104, 132, 66});
}

void chart(SceneMaker& maker, Painter& page, const Vector2d& center, const Vector2d& size) {
  page.rectangle("sheet", center, size, {218, 220, 224});
  constexpr std::array<const char*, 4> kBars{"bar-1", "bar-2", "bar-3", "bar-4"};
  for (std::size_t i = 0; i < kBars.size(); ++i) {
    const double height_m = size.y() * maker.within(0.35, 0.85);
    page.rectangle(
        kBars[i],
        center + Vector2d{size.x() * (0.24 * static_cast<double>(i) - 0.36), 0.5 * (height_m - 0.9 * size.y())},
        {0.16 * size.x(), height_m}, maker.one_of(kPrints));
  }
}

void picture(SceneMaker& maker, Painter& page, std::size_t motif, const Vector2d& center, const Vector2d& size) {
  switch (motif % 4) {
    case 0: return portrait(maker, page, center, size);
    case 1: return dish(maker, page, center, size);
    case 2: return chart(maker, page, center, size);
    default: return landscape(maker, page, center, size);
  }
}

double letter_height_m(std::string_view title) {
  return std::min(0.046, 0.18 / (6.2 / 7.0 * static_cast<double>(title.size())));
}

/// Paints a cover: a masthead over a picture that fills the page, with lines beside it.
void cover(SceneMaker& maker, Painter& page, std::size_t motif, std::string_view title) {
  picture(maker, page, motif, {0.0, -0.035}, {0.2, 0.2});
  const Rgb8 band = maker.one_of(kPrints);
  page.rectangle("masthead", {0, 0.105}, {0.2, 0.06}, band);
  page.text("title", title, {0, 0.105}, letter_height_m(title), kPrintWhite);
  page.rectangle("price", {0.075, -0.118}, {0.036, 0.022}, kPrintWhite);
  page.print({0.075, -0.118}, {0.03, 0.018}, kPrintInk, 0.006);
}

/// Paints an article: a heading, a picture, columns of print, and a box.
void article(SceneMaker& maker, Painter& page, std::size_t motif, std::string_view title) {
  page.text("heading", title, {0, 0.115}, 0.75 * letter_height_m(title), maker.one_of(kPrints));
  page.rectangle("rule", {0, 0.088}, {0.18, 0.005}, kPrintInk);
  picture(maker, page, motif, {-0.045, 0.035}, {0.1, 0.085});
  page.print({0.055, 0.035}, {0.08, 0.085}, kPrintInk);
  page.print({-0.048, -0.075}, {0.085, 0.11}, kPrintInk);
  const Rgb8 tint = maker.shade(Rgb8{206, 212, 214}, 0.1);
  page.rectangle("box", {0.052, -0.085}, {0.085, 0.085}, tint);
  page.rectangle("box-heading", {0.052, -0.055}, {0.07, 0.014}, maker.one_of(kPrints));
  page.print({0.052, -0.095}, {0.07, 0.05}, kPrintInk);
}

/// Paints an advertisement: a coloured page with one object and a name.
void advertisement(SceneMaker& maker, Painter& page, std::string_view title) {
  const Rgb8 ground = maker.one_of(kPrints);
  page.rectangle("ground", {0, 0}, {0.2, 0.27}, ground);
  page.ellipse("halo", {0, 0.03}, {0.16, 0.16}, maker.shade(ground, 0.25));
  page.rectangle("bottle", {0, 0.01}, {0.048, 0.1}, maker.one_of(kPrints));
  page.rectangle("neck", {0, 0.08}, {0.02, 0.045}, maker.one_of(kPrints));
  page.rectangle("label", {0, 0.0}, {0.048, 0.04}, kPrintWhite);
  page.rectangle("band", {0, -0.1}, {0.2, 0.05}, kPrintWhite);
  page.text("name", title, {0, -0.1}, 0.7 * letter_height_m(title), maker.one_of(kPrints));
}

void add_things(SceneMaker& maker, const Vector2d& half_m) {
  const double edge_m = half_m.y() - 0.045;
  SceneObject& phone =
      maker.box("phone", {0.145, 0.07, 0.009}, {0.1, -edge_m, 0}, {52, 54, 58}, maker.within(-0.1, 0.1));
  Painter{phone, Patch::Face::plus_z}.rectangle("screen", {0, 0}, {0.118, 0.06}, {92, 106, 122});
  const Vector3d tip{-0.32, -edge_m - 0.01, 0.006};
  maker.rod("pen/body", tip, tip + Vector3d{0.12, 0.012, 0}, 0.006, {44, 72, 128});
  maker.rod("pen/cap", tip + Vector3d{0.12, 0.012, 0}, tip + Vector3d{0.16, 0.016, 0}, 0.007, {196, 192, 182});
}

}  // namespace

SurfelScene magazine_scene(std::string_view name, int columns, int rows, std::size_t frames, std::uint64_t seed) {
  SceneMaker maker{name, seed};
  const Vector2d half_m{0.14 * columns + 0.05, 0.18 * rows + 0.08};
  maker.box("floor", {30.0, 30.0, 0.1}, {0.0, 0.0, -0.85}, {124, 116, 104});
  maker.box("table", {2.0 * half_m.x(), 2.0 * half_m.y(), 0.04}, {0.0, 0.0, -0.04}, {158, 159, 160});
  const std::size_t first = maker.below(kTitles.size());
  std::size_t pictures = maker.below(4);
  for (int i = 0; i < columns * rows; ++i) {
    const int row = i / columns;
    const double turn_rad = maker.within(-0.22, 0.22);
    const Vector3d at{0.262 * (i % columns - 0.5 * (columns - 1)) + maker.within(-0.022, 0.022),
                      0.35 * (row - 0.5 * (rows - 1)) + 0.03 + maker.within(-0.018, 0.018), 0.0};
    SceneObject& body =
        maker.box("magazine-" + std::to_string(i + 1), {kPageWidth_m, kPageHeight_m, 0.004 + 0.002 * (i % 3)}, at,
                  maker.one_of(kPapers), turn_rad);
    Painter page{body, Patch::Face::plus_z};
    const std::string_view title = kTitles[(first + static_cast<std::size_t>(i)) % kTitles.size()];
    // Covers and articles alternate; after every fourth picture they swap motifs.
    const std::size_t motif = pictures + pictures / 4;
    pictures += i % 3 == 2 ? 0 : 1;
    switch (i % 3) {
      case 0: cover(maker, page, motif, title); break;
      case 1: article(maker, page, motif, title); break;
      default: advertisement(maker, page, title); break;
    }
  }
  add_things(maker, half_m);
  SurfelScene made{std::move(maker.scene()), {}, frames, {}, {}};
  made.scene.workspace = Box{{-half_m.x(), -half_m.y(), -0.05}, {half_m.x(), half_m.y(), 0.3}};
  made.path.targets = Box{{-0.7 * half_m.x(), -0.5 * half_m.y(), 0.0}, {0.7 * half_m.x(), 0.5 * half_m.y(), 0.0}};
  made.path.azimuth_from_rad = -2.6;
  made.path.azimuth_to_rad = -0.5;
  made.path.elevation_from_rad = 0.7;
  made.path.elevation_to_rad = 1.25;
  made.path.distance_from_m = 0.75;
  made.path.distance_to_m = 1.2;
  return made;
}

}  // namespace saccade
