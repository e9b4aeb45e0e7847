// SPDX-License-Identifier: Apache-2.0
#pragma once
// SceneMaker: draws bodies with painted parts at random, for the surfel scenes.

#include <span>
#include <string>
#include <string_view>

#include "saccade/core/seeded_random.hpp"
#include "saccade/scene/rendered_sequence.hpp"

namespace saccade {

/// Builder of a random scene. Call members that draw random numbers in separate statements: C++ leaves the order of a
/// call's arguments to the compiler.
class SceneMaker {
 public:
  SceneMaker(std::string_view name, std::uint64_t seed) : random_{seed} { scene_.name = name; }

  [[nodiscard]] double within(double low, double high) { return random_.uniform(low, high); }
  [[nodiscard]] std::size_t below(std::size_t end) { return random_.below(end); }
  /// Returns one of the colours at random, never the last result.
  [[nodiscard]] Rgb8 one_of(std::span<const Rgb8> colors);
  /// Returns a slightly lighter or darker colour, as objects of one make vary.
  [[nodiscard]] Rgb8 shade(const Rgb8& color, double spread = 0.08);

  /// Adds a body. References stay valid until the next body is added.
  SceneObject& add(const std::string& name, Shape shape, const Pose& T_world_object, const Rgb8& color);
  /// Adds a box that stands on `at`, turned about z.
  SceneObject& box(const std::string& name, const Eigen::Vector3d& size_m, const Eigen::Vector3d& at, const Rgb8& color,
                   double turn_rad = 0.0);
  /// Adds a cylinder between two points.
  SceneObject& rod(const std::string& name, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_m,
                   const Rgb8& color);
  /// Adds a smooth cable through the points, one segment of many rods. Expects at least one point.
  void cable(const std::string& name, std::span<const Eigen::Vector3d> points, double radius_m, const Rgb8& color);

  [[nodiscard]] Scene& scene() { return scene_; }

 private:
  SeededRandom random_;
  Rgb8 last_{};
  Scene scene_;
};

/// Painter of one face of a body. Segments are named NAME/PART after the body.
class Painter {
 public:
  Painter(SceneObject& object, Patch::Face face) : object_{object}, face_{face} {}
  void rectangle(const char* part, const Eigen::Vector2d& center_m, const Eigen::Vector2d& size_m, const Rgb8& color) {
    put(Patch::Kind::rectangle, part, center_m, size_m, color);
  }
  void ellipse(const char* part, const Eigen::Vector2d& center_m, const Eigen::Vector2d& size_m, const Rgb8& color) {
    put(Patch::Kind::ellipse, part, center_m, size_m, color);
  }
  /// Adds small print, which belongs to the segment below.
  void print(const Eigen::Vector2d& center_m, const Eigen::Vector2d& size_m, const Rgb8& color, double line_m = 0.004);
  /// Writes letters of one height around a centre; each letter is a segment.
  void text(const char* part, std::string_view letters, const Eigen::Vector2d& center_m, double height_m,
            const Rgb8& color);

 private:
  Patch& put(Patch::Kind kind, const std::string& part, const Eigen::Vector2d& center_m, const Eigen::Vector2d& size_m,
             const Rgb8& color);
  SceneObject& object_;
  Patch::Face face_;
};

struct WorkshopPlan {
  int rows{2};
  int tools_per_row{5};
  double height_m{0.7};
  bool bench{false};  ///< with bins on it, below the panels
  std::array<Rgb8, 2> boards{};
};
/// Makes a scene with two thin panels, a gap between them, before a wall, and tools on them.
[[nodiscard]] SurfelScene workshop_scene(std::string_view name, const WorkshopPlan& plan, std::size_t frames,
                                         std::uint64_t seed);
/// Makes a cluttered desk before a wall with a thin pinboard.
[[nodiscard]] SurfelScene desk_scene(std::string_view name, std::size_t frames, std::uint64_t seed);
/// Makes a grey table with magazines and some other objects.
[[nodiscard]] SurfelScene magazine_scene(std::string_view name, int columns, int rows, std::size_t frames,
                                         std::uint64_t seed);

}  // namespace saccade
