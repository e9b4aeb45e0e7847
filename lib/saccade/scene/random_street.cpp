// SPDX-License-Identifier: Apache-2.0
// random_street: a street between houses, for scans to label.
#include <Eigen/Geometry>
#include <numbers>

#include "saccade/scene/internal/scene_maker.hpp"

namespace saccade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Face = Patch::Face;

constexpr double kHalfLength_m{28.0};
constexpr double kHalfRoad_m{3.5};
constexpr double kPavement_m{2.5};
constexpr double kKerb_m{0.12};
constexpr double kHouseFront_m{kHalfRoad_m + kPavement_m};
constexpr std::array<Rgb8, 6> kPlasters{
    {{214, 196, 164}, {186, 120, 92}, {206, 206, 200}, {168, 160, 146}, {224, 208, 150}, {150, 104, 84}}};
constexpr std::array<Rgb8, 6> kPaints{
    {{150, 30, 34}, {36, 62, 110}, {226, 226, 226}, {46, 48, 52}, {140, 146, 150}, {60, 96, 70}}};

/// Street along x; its houses stand at ±y.
class StreetMaker {
 public:
  StreetMaker(const std::string& name, std::uint64_t seed) : maker_{name, seed} {}

  Scene make() {
    add_ground();
    for (const double side : {-1.0, 1.0}) add_houses(side);
    for (int i = 0; i < 7; ++i) {
      const double side = i % 2 == 0 ? -1.0 : 1.0;
      const double x = -22.0 + 7.0 * i + maker_.within(-1.2, 1.2);
      add_car("car-" + std::to_string(i + 1), {x, side * (kHalfRoad_m - 1.05)});
    }
    for (int i = 0; i < 6; ++i) {
      const double side = i % 2 == 0 ? 1.0 : -1.0;
      const double x = -24.0 + 9.0 * i + maker_.within(-1.0, 1.0);
      add_tree("tree-" + std::to_string(i + 1), {x, side * (kHalfRoad_m + 0.6), kKerb_m});
    }
    for (int i = 0; i < 4; ++i) {
      const double side = i % 2 == 0 ? -1.0 : 1.0;
      add_lamp_post("lamp-post-" + std::to_string(i + 1), {-19.0 + 13.0 * i, side * (kHalfRoad_m + 0.3), kKerb_m},
                    side);
    }
    for (int i = 0; i < 3; ++i) {
      const double x = -15.0 + 14.0 * i + maker_.within(-1.0, 1.0);
      add_sign("sign-" + std::to_string(i + 1), {x, kHalfRoad_m + 0.35, kKerb_m});
    }
    for (int i = 0; i < 5; ++i) {
      const double side = i % 2 == 0 ? 1.0 : -1.0;
      const double x = maker_.within(-20.0, 20.0);
      add_person("person-" + std::to_string(i + 1), {x, side * (kHalfRoad_m + 1.5), kKerb_m});
    }
    for (int i = 0; i < 5; ++i) {
      const double side = i % 2 == 0 ? -1.0 : 1.0;
      const double x = maker_.within(-24.0, 24.0);
      const Vector3d at{x, side * (kHouseFront_m - 0.35), kKerb_m};
      maker_.box("bin-" + std::to_string(i + 1), {0.55, 0.55, 1.05}, at, maker_.one_of(kPaints));
    }
    Scene& scene = maker_.scene();
    scene.workspace = {{-kHalfLength_m, -16.0, -0.2}, {kHalfLength_m, 16.0, 16.0}};
    for (const double x : {-16.0, 0.5, 17.0}) {
      Pose T_world_scanner{Pose::Identity()};
      T_world_scanner.translation() = Vector3d{x, 0.4, 1.8};
      scene.scan.push_back(T_world_scanner);
    }
    return std::move(scene);
  }

 private:
  void add_ground() {
    SceneObject& road = maker_.box("road", {2 * kHalfLength_m, 2 * kHalfRoad_m, 0.3}, {0, 0, -0.3}, {84, 84, 88});
    road.texture = {Texture::Kind::speckle, 0.05, 0.85};
    for (const double side : {-1.0, 1.0}) {
      SceneObject& pavement =
          maker_.box(side < 0 ? "pavement-right" : "pavement-left", {2 * kHalfLength_m, kPavement_m, 0.3 + kKerb_m},
                     {0, side * (kHalfRoad_m + 0.5 * kPavement_m), -0.3}, {150, 146, 140});
      pavement.texture = {Texture::Kind::checker, 0.4, 0.93};
    }
  }

  /// Windows and the door belong to their house.
  void add_houses(double side) {
    double x = -kHalfLength_m;
    for (int i = 0; x < kHalfLength_m - 4.0; ++i) {
      const double width = std::min(maker_.within(7.0, 12.0), kHalfLength_m - x);
      const double height = maker_.within(6.0, 12.0);
      const double setback = maker_.within(0.0, 0.4);
      const std::string name = std::string{side < 0 ? "house-right-" : "house-left-"} + std::to_string(i + 1);
      SceneObject& house =
          maker_.box(name, {width - 0.05, 8.0, height}, {x + 0.5 * width, side * (kHouseFront_m + setback + 4.0), -0.1},
                     maker_.shade(maker_.one_of(kPlasters)));
      const int floors = static_cast<int>((height - 1.0) / 2.9);
      const int across = static_cast<int>(width / 2.4);
      for (int floor = 0; floor < floors; ++floor) {
        for (int k = 0; k < across; ++k) {
          Patch window;
          window.face = side < 0 ? Face::plus_y : Face::minus_y;
          window.center_m = {(k + 0.5) * width / across - 0.5 * width, 1.9 + 2.9 * floor};
          window.size_m = {1.1, 1.4};
          window.color = {70, 84, 98};
          window.segment = name;
          house.patches.push_back(window);
        }
      }
      x += width;
    }
  }

  void add_car(const std::string& name, const Vector2d& at) {
    const double length = maker_.within(3.8, 4.7);
    const Rgb8 paint = maker_.one_of(kPaints);
    maker_.box(name + "/body", {length, 1.75, 0.6}, {at.x(), at.y(), 0.28}, paint).segment = name;
    Pose T_world_cabin{Pose::Identity()};
    T_world_cabin.translation() = Vector3d{at.x() - 0.1, at.y(), 0.7};
    maker_.add(name + "/cabin", SuperquadricShape{{0.27 * length, 0.82, 0.42}, 0.35, 0.35}, T_world_cabin, {52, 60, 70})
        .segment = name;
    int wheel = 0;
    for (const double x : {-0.31 * length, 0.31 * length}) {
      for (const double y : {-0.78, 0.78}) {
        const Vector3d middle{at.x() + x, at.y() + y, 0.32};
        maker_
            .rod(name + "/wheel-" + std::to_string(++wheel), middle - Vector3d{0, 0.11, 0},
                 middle + Vector3d{0, 0.11, 0}, 0.32, {30, 30, 32})
            .segment = name;
      }
    }
  }

  void add_tree(const std::string& name, const Vector3d& foot) {
    const double trunk = maker_.within(2.0, 2.8);
    maker_.rod(name + "/trunk", foot, foot + Vector3d{0, 0, trunk + 0.6}, maker_.within(0.12, 0.2), {96, 78, 60})
        .segment = name;
    const std::size_t tufts = 9 + maker_.below(6);
    for (std::size_t i = 0; i < tufts; ++i) {
      const double angle = maker_.within(0.0, 2.0 * std::numbers::pi);
      const double reach = maker_.within(0.0, 1.1);
      const double up = maker_.within(0.0, 1.8);
      const double radius = maker_.within(0.4, 0.8);
      Pose T_world_tuft{Pose::Identity()};
      T_world_tuft.translation() = foot + Vector3d{reach * std::cos(angle), reach * std::sin(angle), trunk + up};
      SceneObject& tuft =
          maker_.add(name + "/tuft-" + std::to_string(i + 1), SphereShape{radius}, T_world_tuft, {78, 112, 58});
      tuft.texture = {Texture::Kind::speckle, 0.08, 0.6};
      tuft.segment = name;
    }
  }

  void add_lamp_post(const std::string& name, const Vector3d& foot, double side) {
    const Vector3d top = foot + Vector3d{0, 0, 5.0};
    const Vector3d head = top + Vector3d{0, -side * 1.2, 0.1};
    maker_.rod(name + "/pole", foot, top, 0.07, {104, 110, 112}).segment = name;
    maker_.rod(name + "/arm", top, head, 0.04, {104, 110, 112}).segment = name;
    maker_.box(name + "/head", {0.25, 0.6, 0.12}, head - Vector3d{0, 0, 0.1}, {190, 190, 184}).segment = name;
  }

  void add_sign(const std::string& name, const Vector3d& foot) {
    maker_.rod(name + "/pole", foot, foot + Vector3d{0, 0, 2.5}, 0.03, {140, 144, 146}).segment = name;
    const Vector3d middle = foot + Vector3d{0, 0, 2.2};
    maker_.rod(name + "/disc", middle + Vector3d{-0.04, 0, 0}, middle + Vector3d{-0.06, 0, 0}, 0.3, {190, 36, 40})
        .segment = name;
  }

  void add_person(const std::string& name, const Vector3d& foot) {
    const Rgb8 trousers = maker_.one_of(kPaints);
    const Rgb8 coat = maker_.one_of(kPaints);
    for (const double y : {-0.1, 0.1}) {
      maker_
          .rod(name + (y < 0 ? "/leg-1" : "/leg-2"), foot + Vector3d{0, y, 0}, foot + Vector3d{0, y, 0.85}, 0.08,
               trousers)
          .segment = name;
    }
    Pose T_world_coat{Pose::Identity()};
    T_world_coat.translation() = foot + Vector3d{0, 0, 0.8};
    maker_.add(name + "/coat", ConeShape{0.25, 0.18, 0.65}, T_world_coat, coat).segment = name;
    Pose T_world_head{Pose::Identity()};
    T_world_head.translation() = foot + Vector3d{0, 0, 1.45};
    maker_.add(name + "/head", SphereShape{0.13}, T_world_head, {206, 164, 140}).segment = name;
  }

  SceneMaker maker_;
};

}  // namespace

Scene random_street(std::uint64_t seed) { return StreetMaker{"street:" + std::to_string(seed), seed}.make(); }

}  // namespace saccade
