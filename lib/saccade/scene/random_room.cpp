// SPDX-License-Identifier: Apache-2.0
// random_room: a furnished room, for scans to label.
#include <Eigen/Geometry>
#include <numbers>

#include "saccade/scene/internal/scene_maker.hpp"

namespace saccade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Face = Patch::Face;

constexpr std::array<Rgb8, 5> kRoomWoods{
    {{186, 146, 98}, {128, 88, 56}, {214, 190, 150}, {96, 66, 46}, {168, 124, 84}}};
constexpr std::array<Rgb8, 6> kFabrics{
    {{92, 104, 118}, {146, 72, 64}, {74, 108, 92}, {186, 164, 120}, {60, 66, 92}, {140, 132, 126}}};
constexpr std::array<Rgb8, 4> kWalls{{{226, 222, 212}, {214, 220, 220}, {230, 226, 222}, {218, 212, 196}}};
constexpr double kWallHeight_m{2.6};

/// Furniture of one room, around its middle.
class RoomMaker {
 public:
  RoomMaker(const std::string& name, std::uint64_t seed) : maker_{name, seed} {
    half_ = {maker_.within(2.0, 3.0), 0.0};
    half_.y() = maker_.within(1.8, 2.5);
  }

  Scene make() {
    add_shell();
    add_table();
    add_shelf();
    add_sofa();
    add_small_things();
    Scene& scene = maker_.scene();
    scene.workspace = {{-half_.x(), -half_.y(), -0.05}, {half_.x(), half_.y(), kWallHeight_m}};
    for (const Vector3d& at :
         {Vector3d{-0.5 * half_.x(), -0.45 * half_.y(), 1.5}, Vector3d{0.55 * half_.x(), 0.35 * half_.y(), 1.6}}) {
      Pose T_world_scanner{Pose::Identity()};
      T_world_scanner.translation() = at;
      scene.scan.push_back(T_world_scanner);
    }
    return std::move(scene);
  }

 private:
  /// Adds a box that is a part of a thing.
  void part(const std::string& thing, const std::string& name, const Vector3d& size_m, const Vector3d& at,
            const Rgb8& color, double turn_rad = 0.0) {
    maker_.box(thing + "/" + name, size_m, at, color, turn_rad).segment = thing;
  }

  /// Adds four legs at the corners of a rectangle.
  void legs(const std::string& thing, const Vector2d& middle, const Vector2d& half, double height_m, double turn_rad,
            const Rgb8& color) {
    const Eigen::Rotation2Dd turn{turn_rad};
    for (int i = 0; i < 4; ++i) {
      const Vector2d corner = middle + turn * Vector2d{(i % 2 == 0 ? -1 : 1) * half.x(), (i < 2 ? -1 : 1) * half.y()};
      part(thing, "leg-" + std::to_string(i + 1), {0.04, 0.04, height_m}, {corner.x(), corner.y(), 0.0}, color,
           turn_rad);
    }
  }

  void add_shell() {
    const double x = half_.x();
    const double y = half_.y();
    const Rgb8 floor_color = maker_.shade(maker_.one_of(kRoomWoods));
    SceneObject& floor = maker_.box("floor", {2 * x + 0.2, 2 * y + 0.2, 0.1}, {0, 0, -0.1}, floor_color);
    floor.texture = {Texture::Kind::checker, 0.18, 0.92};
    const Rgb8 carpet = maker_.one_of(kFabrics);
    Painter{floor, Face::plus_z}.rectangle("carpet", {0.3 * x, -0.3 * y}, {1.3, 0.9}, carpet);
    const Rgb8 paint = maker_.one_of(kWalls);
    maker_.box("ceiling", {2 * x + 0.2, 2 * y + 0.2, 0.1}, {0, 0, kWallHeight_m}, {240, 240, 238});
    SceneObject& left = maker_.box("wall-left", {0.1, 2 * y + 0.2, kWallHeight_m}, {-x - 0.05, 0, 0}, paint);
    Painter{left, Face::plus_x}.rectangle("door", {0.4 * y, 1.0}, {0.9, 2.0}, {150, 110, 76});
    SceneObject& right = maker_.box("wall-right", {0.1, 2 * y + 0.2, kWallHeight_m}, {x + 0.05, 0, 0}, paint);
    Painter{right, Face::minus_x}.rectangle("window", {0.0, 1.5}, {1.6, 1.1}, {190, 210, 226});
    maker_.box("wall-front", {2 * x, 0.1, kWallHeight_m}, {0, -y - 0.05, 0}, paint);
    maker_.box("wall-back", {2 * x, 0.1, kWallHeight_m}, {0, y + 0.05, 0}, paint);
    for (int i = 0; i < 2; ++i) {
      const Vector3d at{(i == 0 ? -0.5 : 0.4) * x, -y + 0.015, maker_.within(1.2, 1.5)};
      const Vector3d size{maker_.within(0.4, 0.8), 0.03, maker_.within(0.3, 0.6)};
      maker_.box("picture-" + std::to_string(i + 1), size, at, maker_.one_of(kFabrics)).texture = {
          Texture::Kind::speckle, 0.08, 0.5};
    }
  }

  void add_chair(const std::string& name, const Vector2d& at, double turn_rad) {
    const Rgb8 wood = maker_.one_of(kRoomWoods);
    const Vector2d back = at + Eigen::Rotation2Dd{turn_rad} * Vector2d{0.0, -0.19};
    part(name, "seat", {0.42, 0.42, 0.04}, {at.x(), at.y(), 0.44}, wood, turn_rad);
    part(name, "back", {0.42, 0.03, 0.46}, {back.x(), back.y(), 0.48}, wood, turn_rad);
    legs(name, at, {0.18, 0.18}, 0.44, turn_rad, wood);
  }

  void add_table() {
    const Vector2d at{-0.05 * half_.x(), 0.2 * half_.y()};
    const Vector2d size{maker_.within(1.2, 1.6), 0.8};
    const Rgb8 wood = maker_.one_of(kRoomWoods);
    part("table", "top", {size.x(), size.y(), 0.04}, {at.x(), at.y(), 0.71}, wood);
    legs("table", at, 0.5 * size - Vector2d{0.06, 0.06}, 0.71, 0.0, wood);
    const std::size_t chairs = 2 + maker_.below(3);
    for (std::size_t i = 0; i < chairs; ++i) {
      const double side = i % 2 == 0 ? -1.0 : 1.0;
      const double along = i < 2 ? -0.32 : 0.32;
      const double turn = maker_.within(-0.3, 0.3);
      add_chair("chair-" + std::to_string(i + 1), {at.x() + along, at.y() + side * 0.62},
                turn + (side < 0 ? 0.0 : std::numbers::pi));
    }
    constexpr double kTop_m{0.75};
    part("monitor", "foot", {0.22, 0.16, 0.015}, {at.x() - 0.3, at.y() + 0.2, kTop_m}, {40, 40, 44});
    part("monitor", "screen", {0.52, 0.03, 0.32}, {at.x() - 0.3, at.y() + 0.24, kTop_m + 0.08}, {30, 32, 38});
    part("monitor", "stem", {0.04, 0.03, 0.1}, {at.x() - 0.3, at.y() + 0.26, kTop_m + 0.01}, {40, 40, 44});
    const Rgb8 mug = maker_.one_of(kFabrics);
    maker_.rod("mug", {at.x() + 0.15, at.y() - 0.1, kTop_m}, {at.x() + 0.15, at.y() - 0.1, kTop_m + 0.1}, 0.04, mug);
    maker_.box("book", {0.2, 0.14, 0.03}, {at.x() + 0.4, at.y() + 0.05, kTop_m}, maker_.one_of(kFabrics), 0.4);
  }

  void add_shelf() {
    const double x = -half_.x() + 0.9;
    const double y = half_.y() - 0.17;
    const Rgb8 wood = maker_.one_of(kRoomWoods);
    for (int i = 0; i < 5; ++i) {
      part("shelf", "board-" + std::to_string(i + 1), {1.2, 0.3, 0.03}, {x, y, 0.05 + 0.4 * i}, wood);
    }
    for (int i = 0; i < 2; ++i) {
      part("shelf", "side-" + std::to_string(i + 1), {0.03, 0.3, 1.7}, {x + (i == 0 ? -0.6 : 0.6), y, 0.0}, wood);
    }
    for (int row = 0; row < 4; ++row) {
      const std::string name = "books-" + std::to_string(row + 1);
      const std::size_t books = 5 + maker_.below(8);
      double at = x - 0.54;
      for (std::size_t i = 0; i < books; ++i) {
        const double thick = maker_.within(0.025, 0.06);
        const double tall = maker_.within(0.2, 0.3);
        part(name, std::to_string(i + 1), {thick, 0.2, tall}, {at + 0.5 * thick, y, 0.08 + 0.4 * row},
             maker_.one_of(kFabrics));
        at += thick + 0.002;
      }
    }
  }

  void add_sofa() {
    const double x = half_.x() - 0.5;
    const double y = -0.25 * half_.y();
    const Rgb8 fabric = maker_.one_of(kFabrics);
    part("sofa", "seat", {0.85, 1.6, 0.42}, {x, y, 0.0}, fabric);
    part("sofa", "back", {0.22, 1.6, 0.4}, {x + 0.32, y, 0.42}, fabric);
    for (int i = 0; i < 2; ++i) {
      part("sofa", "arm-" + std::to_string(i + 1), {0.85, 0.18, 0.2}, {x, y + (i == 0 ? -0.71 : 0.71), 0.42}, fabric);
    }
    Pose T_world_cushion{Pose::Identity()};
    T_world_cushion.translation() = Vector3d{x + 0.05, y + 0.35, 0.42};
    maker_.add("cushion", SuperquadricShape{{0.2, 0.2, 0.07}, 0.9, 0.4}, T_world_cushion, maker_.one_of(kFabrics));
  }

  void add_small_things() {
    const Vector3d plant{half_.x() - 0.35, half_.y() - 0.35, 0.0};
    maker_.rod("pot", plant, plant + Vector3d{0, 0, 0.3}, 0.16, {150, 92, 70});
    for (int i = 0; i < 7; ++i) {
      Pose T_world_leaf{Pose::Identity()};
      const double dx = maker_.within(-0.16, 0.16);
      const double dy = maker_.within(-0.16, 0.16);
      const double dz = maker_.within(0.3, 0.75);
      T_world_leaf.translation() = plant + Vector3d{dx, dy, dz};
      maker_
          .add("plant/" + std::to_string(i + 1), SphereShape{maker_.within(0.08, 0.14)}, T_world_leaf,
               maker_.shade({72, 118, 64}, 0.2))
          .segment = "plant";
    }
    const Vector3d lamp{-half_.x() + 0.3, -half_.y() + 0.35, 0.0};
    maker_.rod("lamp/foot", lamp, lamp + Vector3d{0, 0, 0.03}, 0.14, {60, 60, 62}).segment = "lamp";
    maker_.rod("lamp/pole", lamp, lamp + Vector3d{0, 0, 1.5}, 0.015, {60, 60, 62}).segment = "lamp";
    Pose T_world_shade{Pose::Identity()};
    T_world_shade.translation() = lamp + Vector3d{0, 0, 1.45};
    maker_.add("lamp/shade", ConeShape{0.22, 0.12, 0.25}, T_world_shade, {236, 226, 196}).segment = "lamp";
    const double turn = maker_.within(0.0, 1.5);
    maker_.box("carton", {0.4, 0.3, 0.3}, {-0.6 * half_.x(), -0.75 * half_.y(), 0.0}, {178, 140, 96}, turn);
    maker_.box("cupboard", {0.5, 0.4, 0.9}, {0.15 * half_.x(), -half_.y() + 0.22, 0.0}, maker_.one_of(kRoomWoods));
  }

  SceneMaker maker_;
  Vector2d half_{2.5, 2.0};  ///< half of the room's size
};

}  // namespace

Scene random_room(std::uint64_t seed) { return RoomMaker{"room:" + std::to_string(seed), seed}.make(); }

}  // namespace saccade
