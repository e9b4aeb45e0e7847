// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <unordered_map>

namespace saccade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFacing{0.7};  // smallest cosine between a face's axis and the normals that belong to it

/// Glyphs of seven rows of five cells, from the top; # is ink.
constexpr std::string_view kLetters{"ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"};
constexpr std::array<std::string_view, 36> kCells{
    ".###. #...# #...# ##### #...# #...# #...#", "####. #...# #...# ####. #...# #...# ####.",
    ".###. #...# #.... #.... #.... #...# .###.", "####. #...# #...# #...# #...# #...# ####.",
    "##### #.... #.... ####. #.... #.... #####", "##### #.... #.... ####. #.... #.... #....",
    ".###. #...# #.... #.### #...# #...# .###.", "#...# #...# #...# ##### #...# #...# #...#",
    ".###. ..#.. ..#.. ..#.. ..#.. ..#.. .###.", "..### ...#. ...#. ...#. ...#. #..#. .##..",
    "#...# #..#. #.#.. ##... #.#.. #..#. #...#", "#.... #.... #.... #.... #.... #.... #####",
    "#...# ##.## #.#.# #.#.# #...# #...# #...#", "#...# ##..# ##..# #.#.# #..## #..## #...#",
    ".###. #...# #...# #...# #...# #...# .###.", "####. #...# #...# ####. #.... #.... #....",
    ".###. #...# #...# #...# #.#.# #..#. .##.#", "####. #...# #...# ####. #.#.. #..#. #...#",
    ".###. #...# #.... .###. ....# #...# .###.", "##### ..#.. ..#.. ..#.. ..#.. ..#.. ..#..",
    "#...# #...# #...# #...# #...# #...# .###.", "#...# #...# #...# #...# .#.#. .#.#. ..#..",
    "#...# #...# #...# #.#.# #.#.# ##.## #...#", "#...# #...# .#.#. ..#.. .#.#. #...# #...#",
    "#...# #...# .#.#. ..#.. ..#.. ..#.. ..#..", "##### ....# ...#. ..#.. .#... #.... #####",
    ".###. #...# #..## #.#.# ##..# #...# .###.", "..#.. .##.. ..#.. ..#.. ..#.. ..#.. .###.",
    ".###. #...# ....# ..##. .#... #.... #####", ".###. #...# ....# ..##. ....# #...# .###.",
    "...#. ..##. .#.#. #..#. ##### ...#. ...#.", "##### #.... ####. ....# ....# #...# .###.",
    "..##. .#... #.... ####. #...# #...# .###.", "##### ....# ...#. ...#. ..#.. ..#.. ..#..",
    ".###. #...# #...# .###. #...# #...# .###.", ".###. #...# #...# .#### ....# ...#. .##.."};

/// Axis of the body's frame, in either direction.
struct Axis {
  Eigen::Index index;
  double sign;
  [[nodiscard]] double of(const Vector3d& v) const { return sign * v[index]; }
};

struct Axes {
  Axis right;
  Axis up;
  Axis out;
};

/// Axes by Patch::Face.
constexpr std::array<Axes, 6> kAxes{{{{1, 1.0}, {2, 1.0}, {0, 1.0}},
                                     {{1, -1.0}, {2, 1.0}, {0, -1.0}},
                                     {{0, -1.0}, {2, 1.0}, {1, 1.0}},
                                     {{0, 1.0}, {2, 1.0}, {1, -1.0}},
                                     {{0, 1.0}, {1, 1.0}, {2, 1.0}},
                                     {{0, 1.0}, {1, -1.0}, {2, -1.0}}}};

bool glyph_has(char glyph, double x, double y) {
  const std::string_view cells = kCells[kLetters.find(glyph)];
  const auto column = static_cast<std::size_t>(std::clamp((x + 0.5) * 5.0, 0.0, 4.0));
  const auto row = static_cast<std::size_t>(std::clamp((0.5 - y) * 7.0, 0.0, 6.0));
  return cells[6 * row + column] == '#';  // five cells and a blank
}

/// Tells whether print has ink at a point: words of one to eight steps, in lines that fill two fifths of their pitch.
bool print_has(const Patch& patch, const Vector2d& at_m) {
  const double lines = (0.5 * patch.size_m.y() - at_m.y()) / patch.line_m;
  if (lines - std::floor(lines) > 0.4) return false;
  const auto line = static_cast<std::uint64_t>(std::max(0.0, std::floor(lines)));
  const auto step =
      static_cast<std::uint64_t>(std::max(0.0, std::floor((at_m.x() + 0.5 * patch.size_m.x()) / (0.6 * patch.line_m))));
  std::uint64_t key = (line * 1000003U + step + 1U) * 0x9E3779B97F4A7C15ULL;
  key ^= key >> 29U;
  return key % 6U != 0;  // one step in six is a gap between words
}

/// Tells whether the patch covers the point; for print, whether the point lies in its rectangle.
bool covers(const Patch& patch, const Vector2d& at_m) {
  const Vector2d unit = at_m.cwiseQuotient(patch.size_m);
  if (unit.cwiseAbs().maxCoeff() > 0.5) return false;
  if (patch.kind == Patch::Kind::ellipse) return unit.norm() <= 0.5;
  return patch.kind != Patch::Kind::glyph || glyph_has(patch.glyph, unit.x(), unit.y());
}

}  // namespace

Status validate(const Patch& patch) {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "patch"}; };
  if (!(patch.center_m.allFinite() && patch.size_m.allFinite() && patch.size_m.minCoeff() > 0.0)) {
    return fail("a patch needs a place and two positive sizes");
  }
  if (!(std::isfinite(patch.line_m) && patch.line_m > 0.0)) return fail("the lines of print need a positive distance");
  if (patch.kind == Patch::Kind::glyph && kLetters.find(patch.glyph) == std::string_view::npos) {
    return fail("glyphs are the letters A to Z and the digits");
  }
  if (patch.kind != Patch::Kind::print && patch.segment.empty()) return fail("a patch needs the name of its segment");
  return {};
}

Paint paint_at(const SceneObject& object, const Vector3d& p_object, const Vector3d& normal_object) {
  Paint paint;
  const Patch* print = nullptr;
  for (std::size_t i = object.patches.size(); i-- > 0;) {
    const Patch& patch = object.patches[i];
    const Axes& axes = kAxes[static_cast<std::size_t>(patch.face)];
    if (axes.out.of(normal_object) < kFacing) continue;
    const Vector2d at_m = Vector2d{axes.right.of(p_object), axes.up.of(p_object)} - patch.center_m;
    if (!covers(patch, at_m)) continue;
    if (patch.kind == Patch::Kind::print) {
      paint.fine = true;
      if (print == nullptr && print_has(patch, at_m)) print = &patch;
      continue;
    }
    paint.color = print != nullptr ? print->color : patch.color;
    paint.segment_patch = i + 1;
    return paint;
  }
  paint.color = print != nullptr ? print->color : surface_color(object, p_object);
  return paint;
}

SegmentTable::SegmentTable(const Scene& scene) : names_{""} {
  std::unordered_map<std::string, std::uint16_t> known;
  const auto label_of = [&](const std::string& name) {
    const auto [entry, added] = known.try_emplace(name, static_cast<std::uint16_t>(names_.size()));
    if (added) names_.push_back(name);
    return entry->second;
  };
  for (const SceneObject& object : scene.objects) {
    std::vector<std::uint16_t> labels{label_of(object.segment.empty() ? object.name : object.segment)};
    for (const Patch& patch : object.patches) {
      labels.push_back(patch.kind == Patch::Kind::print ? labels.front() : label_of(patch.segment));
    }
    labels_.push_back(std::move(labels));
  }
  SACCADE_EXPECTS(names_.size() <= std::numeric_limits<std::uint16_t>::max());
}

}  // namespace saccade
