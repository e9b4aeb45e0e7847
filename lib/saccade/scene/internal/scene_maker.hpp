// SPDX-License-Identifier: Apache-2.0
#pragma once
// SceneMaker: bodies with painted parts, drawn at random; the scenes for surfels.

#include <span>
#include <string>
#include <string_view>

#include "saccade/core/seeded_random.hpp"
#include "saccade/scene/rendered_sequence.hpp"

namespace saccade {

/// Whoever calls more than one member that draws does so in separate statements: the order of a call's arguments is the
/// compiler's.
class SceneMaker {
 public:
  SceneMaker(std::string_view name, std::uint64_t seed) : random_{seed} { scene_.name = name; }

  [[nodiscard]] double within(double low, double high) { return random_.uniform(low, high); }
  [[nodiscard]] std::size_t below(std::size_t end) { return random_.below(end); }
  /// One of them, never the one of the last call.
  [[nodiscard]] Rgb8 one_of(std::span<const Rgb8> colors);
  /// A little lighter or darker, as no two things of one make are.
  [[nodiscard]] Rgb8 shade(const Rgb8& color, double spread = 0.08);

  /// References stay good until the next body is added.
  SceneObject& add(const std::string& name, Shape shape, const Pose& T_world_object, const Rgb8& color);
  /// Stands on `at`, turned about z.
  SceneObject& box(const std::string& name, const Eigen::Vector3d& size_m, const Eigen::Vector3d& at, const Rgb8& color,
                   double turn_rad = 0.0);
  /// A cylinder between two points.
  SceneObject& rod(const std::string& name, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_m,
                   const Rgb8& color);
  /// A smooth cable through the points, one segment of many rods. Expects a point at least.
  void cable(const std::string& name, std::span<const Eigen::Vector3d> points, double radius_m, const Rgb8& color);

  [[nodiscard]] Scene& scene() { return scene_; }

 private:
  SeededRandom random_;
  Rgb8 last_{};
  Scene scene_;
};

/// Paints on one face of a body; segments are named NAME/PART after the body.
class Painter {
 public:
  Painter(SceneObject& object, Patch::Face face) : object_{object}, face_{face} {}
  void rectangle(const char* part, const Eigen::Vector2d& center_m, const Eigen::Vector2d& size_m, const Rgb8& color) {
    put(Patch::Kind::rectangle, part, center_m, size_m, color);
  }
  void ellipse(const char* part, const Eigen::Vector2d& center_m, const Eigen::Vector2d& size_m, const Rgb8& color) {
    put(Patch::Kind::ellipse, part, center_m, size_m, color);
  }
  /// Of the segment that it is on.
  void print(const Eigen::Vector2d& center_m, const Eigen::Vector2d& size_m, const Rgb8& color, double line_m = 0.004);
  /// Letters of one height from a centre; every letter is a segment.
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
/// Two thin panels with a gap between them, before a wall; tools on them.
[[nodiscard]] SurfelScene workshop_scene(std::string_view name, const WorkshopPlan& plan, std::size_t frames,
                                         std::uint64_t seed);
/// A cluttered desk before a wall with a thin pinboard.
[[nodiscard]] SurfelScene desk_scene(std::string_view name, std::size_t frames, std::uint64_t seed);
/// Magazines, and a few things, on a grey table.
[[nodiscard]] SurfelScene magazine_scene(std::string_view name, int columns, int rows, std::size_t frames,
                                         std::uint64_t seed);

}  // namespace saccade
