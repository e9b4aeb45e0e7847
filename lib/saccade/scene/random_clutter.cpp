// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/scene.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "saccade/core/seeded_random.hpp"
#include "saccade/scene/internal/tabletop.hpp"

namespace saccade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Body, and the radius of the circle around its foot.
struct Body {
  Shape shape;
  double reach_m{0.0};
};

Body draw_body(SeededRandom& random, std::size_t kind) {
  const double r = random.uniform(0.03, 0.06);
  const double h = random.uniform(0.06, 0.20);
  switch (kind % 7) {
    case 0: {
      const double x = 2.0 * r;
      const double y = random.uniform(0.05, 0.16);
      return {BoxShape{{x, y, h}}, 0.5 * std::hypot(x, y)};
    }
    case 1: return {CylinderShape{r, h}, r};
    case 2: return {SphereShape{r}, r};
    case 3: return {ConeShape{r, random.uniform(0.0, 0.8) * r, h}, r};
    case 4: {
      const double vertical = random.uniform(0.3, 1.2);
      const double horizontal = random.uniform(0.3, 1.2);
      const double y = random.uniform(0.03, 0.06);
      return {SuperquadricShape{{r, y, 0.5 * h}, vertical, horizontal}, std::hypot(r, y)};
    }
    case 5: return {RevolutionShape{{{0.8 * r, 0.0}, {r, 0.4 * h}, {0.5 * r, 0.8 * h}, {0.5 * r, h}}, 0.004}, r};
    default: {
      JugShape jug;
      jug.body = RevolutionShape{{{1.2 * r, 0.0}, {1.2 * r, h}}, 0.005};
      jug.handle_bottom_m = 0.2 * h;
      jug.handle_top_m = 0.85 * h;
      jug.handle_radius_m = 0.006;
      jug.handle_reach_m = 0.03;
      return {jug, 1.2 * r + jug.handle_reach_m + jug.handle_radius_m};
    }
  }
}

Rgb8 draw_color(SeededRandom& random) {
  constexpr std::array<Rgb8, 8> kPalette{{{198, 60, 52},
                                          {70, 120, 200},
                                          {80, 170, 90},
                                          {230, 190, 60},
                                          {150, 90, 170},
                                          {60, 170, 170},
                                          {220, 130, 60},
                                          {190, 190, 185}}};
  return kPalette[random.below(kPalette.size())];
}

}  // namespace

Scene random_clutter(std::uint64_t seed, int objects) {
  SACCADE_EXPECTS(objects >= 1 && objects <= 16);
  const Vector2d kHalfTable_m{0.45, 0.28};  // area for bodies, away from the edges
  constexpr double kGap_m{0.03};
  constexpr int kTries{200};
  SeededRandom random{seed};
  Scene scene = empty_tabletop("clutter:" + std::to_string(seed));
  std::vector<std::pair<Vector2d, double>> taken;
  const std::size_t first_kind = random.below(7);
  for (int i = 0; i < objects; ++i) {
    const Body body = draw_body(random, first_kind + static_cast<std::size_t>(i));
    for (int attempt = 0; attempt < kTries; ++attempt) {
      const Vector2d foot{random.uniform(-kHalfTable_m.x(), kHalfTable_m.x()),
                          random.uniform(-kHalfTable_m.y(), kHalfTable_m.y())};
      const double turn_rad = random.uniform(0.0, 2.0 * std::numbers::pi);
      const bool free = std::all_of(taken.begin(), taken.end(), [&](const auto& other) {
        return (other.first - foot).norm() > other.second + body.reach_m + kGap_m;
      });
      if (!free) continue;
      taken.emplace_back(foot, body.reach_m);
      SceneObject object;
      object.name = "object-" + std::to_string(i + 1);
      object.shape = body.shape;
      object.T_world_object.translation() = Vector3d{foot.x(), foot.y(), 0.0};
      object.T_world_object.linear() = Eigen::AngleAxisd{turn_rad, Vector3d::UnitZ()}.toRotationMatrix();
      object.color = draw_color(random);
      object.texture = {Texture::Kind::checker, 0.025, 0.6};
      scene.objects.push_back(std::move(object));
      break;
    }
  }
  return scene;
}

}  // namespace saccade
