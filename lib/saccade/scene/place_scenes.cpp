// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/place_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "saccade/core/angle.hpp"
#include "saccade/scene/internal/scene_maker.hpp"

namespace saccade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::array<Rgb8, 8> kThingColors{{{186, 146, 98},
                                            {128, 88, 56},
                                            {92, 104, 118},
                                            {146, 72, 64},
                                            {74, 108, 92},
                                            {196, 172, 110},
                                            {60, 66, 112},
                                            {206, 200, 190}}};
constexpr std::array<Rgb8, 3> kWallColors{{{226, 222, 212}, {200, 210, 214}, {220, 206, 190}}};
constexpr double kPlaceHeight_m{2.5};

/// A thing before a wall, in the wall's frame: x along the wall, −y into the room, the wall at y = 0.
struct Thing {
  Shape shape;
  Vector3d at;
  double turn_rad{0.0};
  Rgb8 color{};
};

class PlaceMaker {
 public:
  PlaceMaker(std::string_view name, std::uint64_t seed) : maker_{name, seed} {}

  /// Draws things from one end of a wall to the other.
  std::vector<Thing> draw_things(double from_m, double to_m) {
    std::vector<Thing> things;
    double at = from_m + maker_.within(0.1, 0.3);
    while (at < to_m - 0.15) {
      draw_thing(at, things);
      at += maker_.within(0.4, 0.7);
    }
    return things;
  }

  void add_things(const std::string& name, const std::vector<Thing>& things, const Pose& T_world_wall) {
    for (std::size_t i = 0; i < things.size(); ++i) {
      const Thing& thing = things[i];
      Pose T_wall_thing{Pose::Identity()};
      T_wall_thing.translation() = thing.at;
      T_wall_thing.rotate(Eigen::AngleAxisd{thing.turn_rad, Vector3d::UnitZ()});
      maker_.add(name + "/" + std::to_string(i + 1), thing.shape, T_world_wall * T_wall_thing, thing.color);
    }
  }

  void add_floor(const Vector2d& half) {
    maker_.box("floor", {2 * half.x() + 0.4, 2 * half.y() + 0.4, 0.1}, {0, 0, -0.1}, {150, 132, 112});
    maker_.scene().workspace = {{-half.x(), -half.y(), -0.05}, {half.x(), half.y(), kPlaceHeight_m}};
  }

  void add_wall(const std::string& name, double length_m, const Pose& T_world_wall, const Rgb8& color) {
    Pose T_wall_box{Pose::Identity()};
    T_wall_box.translation() = Vector3d{0.0, 0.05, 0.0};
    maker_.add(name, BoxShape{{length_m, 0.1, kPlaceHeight_m}}, T_world_wall * T_wall_box, color).support = true;
  }

  [[nodiscard]] SceneMaker& maker() { return maker_; }

 private:
  void draw_thing(double along_m, std::vector<Thing>& things) {
    const std::size_t kind = maker_.below(4);
    const Rgb8 color = maker_.one_of(kThingColors);
    const double turn = maker_.within(-0.35, 0.35);
    const double a = maker_.within(0.0, 1.0);
    const double b = maker_.within(0.0, 1.0);
    const double c = maker_.within(0.0, 1.0);
    if (kind == 0) {  // a box on the floor, with another on it
      const Vector3d size{0.25 + 0.3 * a, 0.2 + 0.25 * b, 0.4 + 0.8 * c};
      const Vector3d at{along_m, -0.25 - 0.2 * b, 0.0};
      things.push_back({BoxShape{size}, at, turn, color});
      const Vector3d top{0.4 * size.x(), 0.5 * size.y(), 0.15 + 0.2 * a};
      things.push_back(
          {BoxShape{top}, at + Vector3d{0.05 * b, 0.0, size.z()}, -2.0 * turn, maker_.one_of(kThingColors)});
    } else if (kind == 1) {
      things.push_back({CylinderShape{0.08 + 0.1 * a, 0.5 + 1.1 * b}, {along_m, -0.25 - 0.2 * c, 0.0}, 0.0, color});
    } else if (kind == 2) {  // a board on the wall, with two things on it
      const double height = 0.8 + 0.7 * a;
      things.push_back({BoxShape{{0.45, 0.22, 0.03}}, {along_m, -0.11, height}, 0.0, color});
      things.push_back({SphereShape{0.06 + 0.04 * b}, {along_m - 0.12, -0.12, height + 0.03}, 0.0, {190, 90, 60}});
      things.push_back({BoxShape{{0.12, 0.1, 0.12 + 0.15 * c}},
                        {along_m + 0.1, -0.11, height + 0.03},
                        turn,
                        maker_.one_of(kThingColors)});
    } else {
      things.push_back({BoxShape{{0.3 + 0.2 * a, 0.06, 0.3 + 0.3 * b}}, {along_m, -0.03, 0.9 + 0.5 * c}, 0.0, color});
    }
  }

  SceneMaker maker_;
};

/// Wall k of a room, seen from its middle: its frame stands at the middle of the wall's foot.
Pose wall_of_room(int k, double distance_m) {
  Pose T_world_wall{Pose::Identity()};
  T_world_wall.rotate(Eigen::AngleAxisd{0.5 * std::numbers::pi * k, Vector3d::UnitZ()});
  T_world_wall.translate(Vector3d{0.0, distance_m, 0.0});
  return T_world_wall;
}

/// Turns in the middle of a room, looking outwards and somewhat down.
CarriedPath turning_path(double turn_rad, double start_rad, double eye_radius_m) {
  constexpr int kKnotsPerTurn{16};
  const int knots = std::max(2, static_cast<int>(std::ceil(turn_rad / (2.0 * std::numbers::pi) * kKnotsPerTurn)) + 1);
  CarriedPath path;
  for (int i = 0; i < knots; ++i) {
    const double azimuth = start_rad + turn_rad * i / (knots - 1);
    const Vector3d outwards{std::cos(azimuth), std::sin(azimuth), 0.0};
    path.eyes.push_back(eye_radius_m * outwards + Vector3d{0.0, 0.0, 1.3});
    path.targets.push_back(1.8 * outwards + Vector3d{0.0, 0.0, 0.85});
  }
  return path;
}

PlaceScene loop_scene(const std::string& name, std::uint64_t seed) {
  PlaceMaker place{name, seed};
  SceneMaker& maker = place.maker();
  const double half_x = maker.within(1.9, 2.4);
  const double half_y = maker.within(1.9, 2.4);
  const Vector2d half{half_x, half_y};
  place.add_floor(half);
  for (int k = 0; k < 4; ++k) {
    const double length = k % 2 == 0 ? 2 * half.x() : 2 * half.y();
    const Pose T_world_wall = wall_of_room(k, k % 2 == 0 ? half.y() : half.x());
    const std::string wall = "wall-" + std::to_string(k + 1);
    const Rgb8 color = maker.one_of(kWallColors);
    place.add_wall(wall, length, T_world_wall, color);
    place.add_things(wall, place.draw_things(-0.5 * length + 0.1, 0.5 * length - 0.1), T_world_wall);
  }
  const double start = maker.within(0.0, 2.0 * std::numbers::pi);
  const double radius = maker.within(0.1, 0.3);
  return {std::move(maker.scene()), turning_path(2.0 * std::numbers::pi * 1.1, start, radius), 220};
}

PlaceScene equal_walls(const std::string& name, std::uint64_t seed) {
  PlaceMaker place{name, seed};
  SceneMaker& maker = place.maker();
  const double half = maker.within(1.7, 2.1);
  place.add_floor({half, half});
  const Rgb8 color = maker.one_of(kWallColors);
  const std::vector<Thing> things = place.draw_things(-half + 0.1, half - 0.1);
  for (int k = 0; k < 4; ++k) {
    const std::string wall = "wall-" + std::to_string(k + 1);
    place.add_wall(wall, 2 * half, wall_of_room(k, half), color);
    place.add_things(wall, things, wall_of_room(k, half));
  }
  const double start = maker.within(0.0, 2.0 * std::numbers::pi);
  const double radius = maker.within(0.1, 0.3);
  return {std::move(maker.scene()), turning_path(300.0_deg, start, radius), 167};
}

PlaceScene equal_bays(const std::string& name, std::uint64_t seed) {
  constexpr int kBays{5};
  PlaceMaker place{name, seed};
  SceneMaker& maker = place.maker();
  const double pitch = maker.within(0.9, 1.5);
  const double length = kBays * pitch;
  place.add_floor({0.5 * length, 2.0});
  const std::vector<Thing> things = place.draw_things(-0.5 * pitch, 0.5 * pitch);
  place.add_wall("wall", length, wall_of_room(0, 0.0), maker.one_of(kWallColors));
  for (int bay = 0; bay < kBays; ++bay) {
    Pose T_world_bay{Pose::Identity()};
    T_world_bay.translation().x() = (bay - 0.5 * (kBays - 1)) * pitch;
    place.add_things("bay-" + std::to_string(bay + 1), things, T_world_bay);
  }
  CarriedPath path;
  constexpr int kKnots{12};
  const double reach = 0.5 * length - 0.75 * pitch;
  for (int i = 0; i < kKnots; ++i) {
    const double x = reach * (2.0 * i / (kKnots - 1) - 1.0);
    path.eyes.emplace_back(x, -1.7, 1.2);
    path.targets.emplace_back(x, 0.0, 0.8);
  }
  return {std::move(maker.scene()), std::move(path), static_cast<std::size_t>(std::lround(2.0 * reach / 0.025))};
}

/// Point of the Catmull-Rom spline through the knots; place within 0 and 1.
Vector3d on_spline(const std::vector<Vector3d>& knots, double place) {
  const auto last = static_cast<std::ptrdiff_t>(knots.size()) - 1;
  const double along = place * static_cast<double>(last);
  const std::ptrdiff_t k = std::clamp(static_cast<std::ptrdiff_t>(along), std::ptrdiff_t{0}, last - 1);
  const double s = along - static_cast<double>(k);
  const auto knot = [&](std::ptrdiff_t i) -> Vector3d {  // beyond the ends the path goes straight on
    if (i < 0) return 2.0 * knots.front() - knots[1];
    if (i > last) return 2.0 * knots.back() - knots[static_cast<std::size_t>(last - 1)];
    return knots[static_cast<std::size_t>(i)];
  };
  const Vector3d a = knot(k - 1);
  const Vector3d b = knot(k);
  const Vector3d c = knot(k + 1);
  const Vector3d d = knot(k + 2);
  return 0.5 *
         (2.0 * b + s * (c - a) + s * s * (2.0 * a - 5.0 * b + 4.0 * c - d) + s * s * s * (3.0 * b - a - 3.0 * c + d));
}

}  // namespace

std::vector<Pose> carried_poses(const CarriedPath& path, std::size_t frames, std::uint64_t seed) {
  SACCADE_EXPECTS(frames >= 1 && path.eyes.size() >= 2 && path.eyes.size() == path.targets.size());
  SeededRandom random{seed};
  std::array<double, 9> phases{};
  for (double& phase : phases) phase = 2.0 * std::numbers::pi * random.unit();
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < frames; ++i) {
    const double time_s = static_cast<double>(i) / 30.0;
    const double place = frames > 1 ? static_cast<double>(i) / static_cast<double>(frames - 1) : 0.0;
    const auto swing = [&](double hertz, std::size_t k) {
      return std::sin(2.0 * std::numbers::pi * hertz * time_s + phases.at(k));
    };
    const Vector3d sway{swing(0.31, 0), swing(0.23, 1), swing(0.37, 2)};
    const Vector3d glance{swing(0.29, 3), swing(0.41, 4), swing(0.19, 5)};
    const Vector3d tremor{swing(1.7, 6), swing(2.3, 7), swing(2.9, 8)};
    poses.push_back(look_at(on_spline(path.eyes, place) + path.sway_m * sway + path.tremor_m * tremor,
                            on_spline(path.targets, place) + path.sway_m * glance));
  }
  return poses;
}

Result<PlaceScene> place_scene(std::string_view name) {
  const std::size_t colon = name.find(':');
  const std::string_view kind = name.substr(0, colon);
  if (colon == std::string_view::npos ||
      std::find(kPlaceScenes.begin(), kPlaceScenes.end(), kind) == kPlaceScenes.end()) {
    return Error{Errc::not_found, "no such scene; there are loop:SEED and alike:SEED", std::string{name}};
  }
  const std::string digits{name.substr(colon + 1)};
  if (digits.empty() || digits.size() > 18 || digits.find_first_not_of("0123456789") != std::string::npos) {
    return Error{Errc::invalid_argument, "a seed is a whole number: " + std::string{kind} + ":7", std::string{name}};
  }
  const std::uint64_t seed = std::stoull(digits);
  if (kind == "loop") return loop_scene(std::string{name}, seed);
  return seed % 2 == 1 ? equal_bays(std::string{name}, seed) : equal_walls(std::string{name}, seed);
}

}  // namespace saccade
