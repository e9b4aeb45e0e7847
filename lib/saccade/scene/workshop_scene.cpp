// SPDX-License-Identifier: Apache-2.0
// workshop_scene: thin panels with tools before a wall, as the thesis' first and second scenario.
#include <Eigen/Geometry>
#include <numbers>

#include "saccade/scene/internal/scene_maker.hpp"

namespace saccade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPanelWidth_m{0.9};
constexpr double kThickness_m{0.03};  // thickness of the panels in the thesis
constexpr double kGap_m{0.06};

constexpr std::array<Rgb8, 9> kGrips{{{176, 44, 40},
                                      {208, 164, 48},
                                      {40, 76, 132},
                                      {52, 98, 64},
                                      {198, 100, 44},
                                      {46, 46, 48},
                                      {88, 90, 92},
                                      {176, 128, 80},
                                      {44, 110, 116}}};
constexpr std::array<Rgb8, 4> kWoods{{{188, 144, 96}, {170, 122, 76}, {206, 170, 122}, {152, 104, 66}}};
constexpr std::array<Rgb8, 4> kMetals{{{160, 162, 164}, {136, 138, 142}, {110, 112, 116}, {176, 178, 178}}};
constexpr Rgb8 kBrass{168, 142, 86};
constexpr Rgb8 kRubber{48, 48, 50};
constexpr Rgb8 kLabelPaper{232, 228, 214};
constexpr Rgb8 kLabelInk{44, 44, 48};

/// Slot for a tool: `at` is its lowest point on the panel's front, whose outside is −y.
struct Slot {
  std::string name;
  Vector3d at;
  double height_m;

  [[nodiscard]] Vector3d point(double x_m, double off_m, double z_m) const { return at + Vector3d{x_m, -off_m, z_m}; }
};

/// Hangs up a tool with a shaft, a ring and a grip, such as a screwdriver, a chisel or a file.
void hang_driver(SceneMaker& maker, const Slot& slot, const Rgb8& grip, const Rgb8& ring) {
  const double radius_m = maker.within(0.012, 0.018);
  const double off_m = 1.1 * radius_m;
  const Rgb8 metal = maker.one_of(kMetals);
  maker.rod(slot.name + "/shaft", slot.point(0, off_m, 0), slot.point(0, off_m, 0.52 * slot.height_m), 0.42 * radius_m,
            metal);
  maker.rod(slot.name + "/ring", slot.point(0, off_m, 0.5 * slot.height_m), slot.point(0, off_m, 0.58 * slot.height_m),
            0.85 * radius_m, ring);
  maker.rod(slot.name + "/grip", slot.point(0, off_m, 0.58 * slot.height_m), slot.point(0, off_m, slot.height_m),
            radius_m, grip);
}

void hang_hammer(SceneMaker& maker, const Slot& slot) {
  const double top_m = slot.height_m;
  maker.rod(slot.name + "/sleeve", slot.point(0, 0.018, 0), slot.point(0, 0.018, 0.42 * top_m), 0.015,
            maker.one_of(kGrips));
  maker.rod(slot.name + "/handle", slot.point(0, 0.018, 0.42 * top_m), slot.point(0, 0.018, top_m - 0.03), 0.011,
            maker.one_of(kWoods));
  maker.box(slot.name + "/head", {0.095, 0.028, 0.03}, slot.point(0.005, 0.018, top_m - 0.03), maker.one_of(kMetals));
}

void hang_pliers(SceneMaker& maker, const Slot& slot) {
  const Rgb8 grip = maker.one_of(kGrips);
  const Vector3d joint = slot.point(0, 0.014, 0.6 * slot.height_m);
  maker.rod(slot.name + "/left-grip", slot.point(-0.026, 0.014, 0), joint, 0.009, grip);
  maker.rod(slot.name + "/right-grip", slot.point(0.026, 0.014, 0), joint, 0.009, grip);
  maker.add(slot.name + "/jaws", ConeShape{0.02, 0.007, 0.38 * slot.height_m},
            Pose{Eigen::Translation3d{joint - Vector3d{0, 0, 0.008}}}, maker.one_of(kMetals));
}

void hang_brush(SceneMaker& maker, const Slot& slot) {
  const double width_m = maker.within(0.04, 0.065);
  maker.box(slot.name + "/bristles", {0.94 * width_m, 0.014, 0.32 * slot.height_m}, slot.point(0, 0.012, 0),
            maker.below(2) == 0 ? Rgb8{58, 48, 42} : Rgb8{206, 186, 146});
  maker.box(slot.name + "/ferrule", {width_m, 0.018, 0.2 * slot.height_m}, slot.point(0, 0.012, 0.32 * slot.height_m),
            maker.one_of(kMetals));
  maker.rod(slot.name + "/handle", slot.point(0, 0.012, 0.52 * slot.height_m), slot.point(0, 0.012, slot.height_m),
            0.012, maker.shade(maker.below(2) == 0 ? kWoods[0] : Rgb8{170, 52, 46}));
}

/// Hangs up a roll of tape, its axis across the panel.
void hang_tape(SceneMaker& maker, const Slot& slot, const Rgb8& board) {
  const double radius_m = maker.within(0.042, 0.052);
  const Vector3d center = slot.point(0, 0.0, 0.55 * slot.height_m);
  SceneObject& roll =
      maker.rod(slot.name + "/roll", center, center - Vector3d{0, 0.03, 0}, radius_m, maker.one_of(kGrips));
  Painter face{roll, Patch::Face::plus_z};
  face.ellipse("core", {0, 0}, 1.3 * Vector2d{radius_m, radius_m}, {190, 166, 130});
  face.ellipse("hole", {0, 0}, 1.08 * Vector2d{radius_m, radius_m},
               {static_cast<std::uint8_t>(board[0] * 0.7), static_cast<std::uint8_t>(board[1] * 0.7),
                static_cast<std::uint8_t>(board[2] * 0.7)});
}

void hang_saw(SceneMaker& maker, const Slot& slot) {
  maker.box(slot.name + "/blade", {0.05, 0.004, 0.66 * slot.height_m}, slot.point(0, 0.012, 0), maker.one_of(kMetals));
  SceneObject& handle = maker.box(slot.name + "/handle", {0.075, 0.022, 0.34 * slot.height_m},
                                  slot.point(0, 0.012, 0.66 * slot.height_m), maker.one_of(kWoods));
  Painter{handle, Patch::Face::minus_y}.ellipse("grip", {0, 0.17 * slot.height_m}, {0.04, 0.2 * slot.height_m},
                                                kRubber);
}

void hang_level(SceneMaker& maker, const Slot& slot) {
  SceneObject& body =
      maker.box(slot.name + "/body", {0.045, 0.022, slot.height_m}, slot.point(0, 0.012, 0), maker.one_of(kGrips));
  Painter face{body, Patch::Face::minus_y};
  face.rectangle("vial", {0, 0.72 * slot.height_m}, {0.02, 0.05}, {186, 206, 92});
  face.rectangle("label", {0, 0.34 * slot.height_m}, {0.034, 0.07}, maker.shade(kLabelPaper, 0.05));
  face.print({0, 0.34 * slot.height_m}, {0.028, 0.06}, kLabelInk, 0.008);
}

void hang_can(SceneMaker& maker, const Slot& slot) {
  const double radius_m = maker.within(0.027, 0.033);
  const double off_m = radius_m + 0.002;
  const double top_m = 0.9 * slot.height_m;
  const auto part = [&](const char* what, double from, double to, double radius, const Rgb8& color) {
    maker.rod(slot.name + what, slot.point(0, off_m, from * top_m), slot.point(0, off_m, to * top_m), radius, color);
  };
  part("/can", 0.0, 0.35, radius_m, maker.one_of(kMetals));
  part("/label", 0.35, 0.8, radius_m, maker.one_of(kGrips));
  part("/cap", 0.8, 1.0, 0.92 * radius_m, maker.one_of(kGrips));
}

void hang_tool(SceneMaker& maker, const Slot& slot, std::size_t kind, const Rgb8& board) {
  switch (kind % 10) {
    case 1: return hang_hammer(maker, slot);
    case 2: return hang_pliers(maker, slot);
    case 3: return hang_brush(maker, slot);
    case 4: return hang_driver(maker, slot, maker.one_of(kWoods), kBrass);
    case 5: return hang_tape(maker, slot, board);
    case 6: return hang_saw(maker, slot);
    case 7: return hang_level(maker, slot);
    case 8: return hang_can(maker, slot);
    default: break;
  }
  const Rgb8 grip = maker.one_of(kGrips);
  hang_driver(maker, slot, grip, kind % 10 == 0 ? kRubber : maker.shade(grip, 0.35));
}

void add_bins(SceneMaker& maker, double half_m) {
  maker.box("bench", {2.0 * half_m + 0.2, 0.46, 0.04}, {0, -0.2, -0.16}, {150, 120, 88});
  constexpr std::array<Rgb8, 3> kBins{{{52, 84, 134}, {166, 50, 44}, {96, 100, 104}}};
  constexpr int kCount{4};
  for (int i = 0; i < kCount; ++i) {
    const double x_m = 2.0 * half_m * ((i + 0.5) / kCount - 0.5) + maker.within(-0.05, 0.05);
    const double turn_rad = maker.within(-0.15, 0.15);
    SceneObject& bin = maker.box("bin-" + std::to_string(i + 1), {0.16, 0.12, 0.085}, {x_m, -0.22, -0.12},
                                 maker.shade(maker.one_of(kBins)), turn_rad);
    Painter front{bin, Patch::Face::minus_y};
    front.rectangle("label", {0, 0.045}, {0.085, 0.038}, maker.shade(kLabelPaper, 0.04));
    front.print({0, 0.045}, {0.075, 0.03}, kLabelInk, 0.009);
  }
}

}  // namespace

SurfelScene workshop_scene(std::string_view name, const WorkshopPlan& plan, std::size_t frames, std::uint64_t seed) {
  SceneMaker maker{name, seed};
  const auto panels = static_cast<int>(plan.boards.size());
  const double half_m = 0.5 * panels * (kPanelWidth_m + kGap_m);
  maker.box("wall", {30.0, 0.1, 6.0}, {0.0, 0.14, -2.5}, {218, 217, 210});
  for (int k = 0; k < panels; ++k) {
    const std::string panel = "panel-" + std::to_string(k + 1);
    const Rgb8 board_color = plan.boards[static_cast<std::size_t>(k)];
    const double x_m = (k - 0.5 * (panels - 1)) * (kPanelWidth_m + kGap_m);
    SceneObject& board = maker.box(panel, {kPanelWidth_m, kThickness_m, plan.height_m}, {x_m, 0.0, 0.0}, board_color);
    Painter front{board, Patch::Face::minus_y};
    front.rectangle("sign", {0.0, plan.height_m - 0.035}, {0.3, 0.05}, kLabelPaper);
    front.text("sign", k == 0 ? "A1" : "A2", {0.0, plan.height_m - 0.035}, 0.036, kLabelInk);
    const double pitch_m = (plan.height_m - 0.1) / plan.rows;
    // Each kind of tool occurs once before any occurs again.
    std::size_t kind = maker.below(10);
    for (int row = 0; row < plan.rows; ++row) {
      for (int i = 0; i < plan.tools_per_row; ++i) {
        const double slot_x_m = x_m + kPanelWidth_m * ((i + 0.5) / plan.tools_per_row - 0.5);
        const double height_m = std::min(pitch_m - 0.07, maker.within(0.17, 0.24));
        const Slot slot{panel + "/tool-" + std::to_string(row * plan.tools_per_row + i + 1),
                        {slot_x_m + maker.within(-0.01, 0.01), -0.5 * kThickness_m, 0.04 + pitch_m * row},
                        height_m};
        hang_tool(maker, slot, kind, board_color);
        kind += 3;
      }
    }
  }
  if (plan.bench) add_bins(maker, half_m);
  SurfelScene made{std::move(maker.scene()), {}, frames, {}, {}};
  const double low_m = plan.bench ? -0.12 : 0.0;
  made.scene.workspace = Box{{-half_m - 0.05, -0.45, low_m - 0.1}, {half_m + 0.05, 0.1, plan.height_m + 0.1}};
  made.path.targets =
      Box{{-0.75 * half_m, 0.0, low_m + 0.2 * plan.height_m}, {0.75 * half_m, 0.0, 0.75 * plan.height_m}};
  made.path.azimuth_from_rad = -0.5 * std::numbers::pi - 0.5;
  made.path.azimuth_to_rad = -0.5 * std::numbers::pi + 0.5;
  made.path.elevation_from_rad = -0.2;
  made.path.elevation_to_rad = 0.35;
  return made;
}

}  // namespace saccade
