// SPDX-License-Identifier: Apache-2.0
#pragma once
// Clouds of surfaces one behind the other before a camera at the origin that looks along +z, with the surface that each
// point belongs to.

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "saccade/core/pose.hpp"

namespace saccade::test {

/// Kind of surface under a point: a side that faces the camera, one that is turned away from it, or a wall or floor
/// behind.
enum class Side : std::uint8_t { front, back, wall };

struct LayeredScene {
  std::string name;
  std::vector<Eigen::Vector3f> positions_m;
  std::vector<Side> sides;  ///< by point
};

class SceneMaker {
 public:
  SceneMaker(std::string name, std::uint32_t seed) : rng_{seed} { scene_.name = std::move(name); }

  /// Adds count points of a surface over the unit square: in rows with a jitter of a cell, so that no gaps are wide, or
  /// anywhere.
  SceneMaker& surface(int count, const std::function<Eigen::Vector3d(double, double)>& at, double noise_m = 0.0,
                      Side side = Side::front, bool in_rows = true) {
    std::uniform_real_distribution<double> any{0.0, 1.0};
    std::normal_distribution<double> noise{0.0, 1.0};
    const int rows = static_cast<int>(std::sqrt(count));
    for (int i = 0; i < rows * rows; ++i) {
      const double a = in_rows ? (i % rows + any(rng_)) / rows : any(rng_);
      const double b = in_rows ? (i / rows + any(rng_)) / rows : any(rng_);
      Eigen::Vector3d p = at(a, b);
      p *= 1.0 + noise_m * noise(rng_) / p.norm();
      scene_.positions_m.push_back(p.cast<float>());
      scene_.sides.push_back(side);
    }
    return *this;
  }
  /// Adds a parallelogram around a place.
  SceneMaker& patch(int count, const Eigen::Vector3d& middle, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                    double noise_m = 0.0, Side side = Side::front, bool in_rows = true) {
    return surface(
        count, [=](double s, double t) { return Eigen::Vector3d{middle + (s - 0.5) * a + (t - 0.5) * b}; }, noise_m,
        side, in_rows);
  }
  /// Adds a plane that fills the picture, tilted by an angle about x and y.
  SceneMaker& plane(int count, double depth_m, double tilt_rad, double noise_m = 0.0, Side side = Side::front,
                    bool in_rows = true) {
    return patch(count, {0.0, 0.0, depth_m}, {1.0, 0.0, 0.4 * std::tan(tilt_rad)},
                 {0.0, std::cos(tilt_rad), std::sin(tilt_rad)}, noise_m, side, in_rows);
  }
  SceneMaker& ball(int count, const Eigen::Vector3d& middle, double radius_m, double noise_m = 0.0) {
    const std::size_t first = scene_.sides.size();
    const auto out = [](double s, double t) {
      const double z = 2.0 * s - 1.0;
      const double r = std::sqrt(1.0 - z * z);
      return Eigen::Vector3d{r * std::cos(2.0 * M_PI * t), r * std::sin(2.0 * M_PI * t), z};
    };
    surface(
        count, [=](double s, double t) { return Eigen::Vector3d{middle + radius_m * out(s, t)}; }, noise_m);
    for (std::size_t i = first; i < scene_.sides.size(); ++i) {
      const Eigen::Vector3d p = scene_.positions_m[i].cast<double>();
      if ((p - middle).dot(p) > 0.0) scene_.sides[i] = Side::back;
    }
    return *this;
  }
  /// Adds the six sides of a box that is turned about y.
  SceneMaker& box(int count, const Eigen::Vector3d& middle, double edge_m, double turn_rad, double noise_m = 0.0) {
    const Eigen::Vector3d x = edge_m * Eigen::Vector3d{std::cos(turn_rad), 0.0, std::sin(turn_rad)};
    const Eigen::Vector3d y = edge_m * Eigen::Vector3d::UnitY();
    const Eigen::Vector3d z = edge_m * Eigen::Vector3d{-std::sin(turn_rad), 0.0, std::cos(turn_rad)};
    const auto face = [&](const Eigen::Vector3d& out, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      const Eigen::Vector3d at = middle + 0.5 * out;
      patch(count / 6, at, a, b, noise_m, out.dot(at) < 0.0 ? Side::front : Side::back);
    };
    for (const double sign : {-1.0, 1.0}) {
      face(sign * z, x, y);
      face(sign * y, x, z);
      face(sign * x, y, z);
    }
    return *this;
  }
  [[nodiscard]] LayeredScene made() { return std::move(scene_); }

 private:
  std::mt19937 rng_;
  LayeredScene scene_;
};

/// Returns twenty scenes: planes, boxes, balls, steps, poles; dense and sparse, oblique, rough and rounded.
inline std::vector<LayeredScene> layered_scenes() {
  using Maker = SceneMaker;
  constexpr double kWall_m{1.6};
  const auto wall = [&](Maker& maker, int count = 12'000) -> Maker& {
    return maker.plane(count, kWall_m, 0.0, 0.0, Side::wall);
  };
  std::vector<LayeredScene> scenes;
  std::uint32_t seed{1};
  const auto add = [&](const std::string& name, const std::function<void(Maker&)>& make) {
    Maker maker{name, seed++};
    make(maker);
    scenes.push_back(maker.made());
  };
  add("dense plane", [](Maker& m) { m.plane(20'000, 1.0, 0.0); });
  add("plane at 45 degrees", [](Maker& m) { m.plane(20'000, 1.0, 0.785); });
  add("plane at 70 degrees", [](Maker& m) { m.plane(20'000, 1.0, 1.22); });
  add("plane at 80 degrees", [](Maker& m) { m.plane(20'000, 1.3, 1.4); });
  add("sparse plane", [](Maker& m) { m.plane(3'000, 1.0, 0.3); });
  add("plane of any places", [](Maker& m) { m.plane(20'000, 1.0, 0.5, 0.0, Side::front, false); });
  add("rough plane, 1 mm", [](Maker& m) { m.plane(20'000, 1.0, 0.5, 0.001); });
  add("rough plane, 3 mm", [](Maker& m) { m.plane(20'000, 1.0, 0.9, 0.003); });
  add("two sheets 5 cm apart", [](Maker& m) { m.plane(20'000, 1.0, 0.2).plane(20'000, 1.05, 0.2, 0.0, Side::wall); });
  add("rough sheet, wall", [&](Maker& m) { wall(m.plane(18'000, 1.0, 0.2, 0.002)); });
  add("sparse sheet, wall", [&](Maker& m) { wall(m.plane(6'000, 1.0, 0.2), 20'000); });
  add("box, wall", [&](Maker& m) { wall(m.box(18'000, {0.0, 0.0, 1.0}, 0.3, 0.6)); });
  add("sparse box, wall", [&](Maker& m) { wall(m.box(5'000, {0.0, 0.0, 1.0}, 0.3, 0.6)); });
  add("box, table", [&](Maker& m) {
    m.box(20'000, {0.0, 0.0, 1.0}, 0.2, 0.4)
        .patch(20'000, {0.0, 0.1, 1.2}, {1.2, 0.0, 0.0}, {0.0, 0.25, -0.8}, 0.0, Side::wall);
  });
  add("ball, wall", [&](Maker& m) { wall(m.ball(18'000, {0.0, 0.0, 1.0}, 0.2)); });
  add("sparse rough ball, wall", [&](Maker& m) { wall(m.ball(8'000, {0.0, 0.0, 1.0}, 0.2, 0.001)); });
  add("steps", [](Maker& m) {
    for (int i = -3; i <= 3; ++i) {
      m.patch(3'000, {0.0, 0.06 * i, 1.2 - 0.06 * i}, {0.6, 0.0, 0.0}, {0.0, 0.06, 0.0});
      m.patch(3'000, {0.0, 0.06 * i + 0.03, 1.17 - 0.06 * i}, {0.6, 0.0, 0.0}, {0.0, 0.0, 0.06});
    }
  });
  add("poles, wall", [&](Maker& m) {
    for (int i = -4; i <= 4; ++i) m.patch(2'000, {0.05 * i, 0.0, 1.0}, {0.01, 0.0, 0.0}, {0.0, 0.5, 0.1});
    wall(m, 20'000);
  });
  add("rounded depths", [](Maker& m) {
    m.surface(20'000, [](double s, double t) {
      const double z = 1.2 + 0.2 * std::sin(9.0 * s) * std::cos(7.0 * t);
      const double rounded = std::round(z / 0.006) * 0.006;
      return Eigen::Vector3d{(s - 0.5) * rounded, (t - 0.5) * rounded, rounded};
    });
  });
  add("ball, rough wall, any places", [](Maker& m) {
    m.ball(20'000, {0.05, 0.0, 1.0}, 0.15, 0.002).plane(20'000, 1.5, 0.3, 0.003, Side::wall, false);
  });
  return scenes;
}

}  // namespace saccade::test
