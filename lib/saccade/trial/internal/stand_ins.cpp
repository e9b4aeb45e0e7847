// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/internal/stand_ins.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "saccade/core/angle.hpp"
#include "saccade/scene/scene.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;
using Bodies = std::vector<TriangleMesh>;

constexpr std::uint32_t kAround{36};
constexpr std::uint32_t kDown{18};

/// Returns an ellipsoid; `axis_rad` turns it about x, y and z, in this order.
TriangleMesh ellipsoid(const Vector3d& center, const Vector3d& semi_axes, const Vector3d& axis_rad = Vector3d::Zero()) {
  const Eigen::Matrix3d turned =
      (Eigen::AngleAxisd{axis_rad.z(), Vector3d::UnitZ()} * Eigen::AngleAxisd{axis_rad.y(), Vector3d::UnitY()} *
       Eigen::AngleAxisd{axis_rad.x(), Vector3d::UnitX()})
          .toRotationMatrix();
  const auto at = [&](double down_rad, double around_rad) {
    const Vector3d unit{std::sin(down_rad) * std::cos(around_rad), std::sin(down_rad) * std::sin(around_rad),
                        std::cos(down_rad)};
    return Eigen::Vector3f{(center + turned * semi_axes.cwiseProduct(unit)).cast<float>()};
  };
  TriangleMesh mesh;
  mesh.vertices.push_back(at(0.0, 0.0));
  for (std::uint32_t i = 1; i < kDown; ++i) {
    for (std::uint32_t j = 0; j < kAround; ++j) mesh.vertices.push_back(at(180_deg * i / kDown, 360_deg * j / kAround));
  }
  mesh.vertices.push_back(at(180_deg, 0.0));
  const std::uint32_t last = static_cast<std::uint32_t>(mesh.vertices.size()) - 1;
  for (std::uint32_t j = 0; j < kAround; ++j) {
    const std::uint32_t next = (j + 1) % kAround;
    mesh.triangles.push_back({0, 1 + j, 1 + next});
    mesh.triangles.push_back({last, last - kAround + next, last - kAround + j});
    for (std::uint32_t i = 0; i + 2 < kDown; ++i) {
      const std::uint32_t upper = 1 + i * kAround;
      const std::uint32_t lower = upper + kAround;
      mesh.triangles.push_back({upper + j, lower + j, lower + next});
      mesh.triangles.push_back({upper + j, lower + next, upper + next});
    }
  }
  return mesh;
}

/// Returns a limb: an ellipsoid from one point to another, its ends a little beyond them.
TriangleMesh limb(const Vector3d& from, const Vector3d& to, double thickness) {
  const Vector3d along = to - from;
  const double down_rad = std::acos(along.normalized().z());
  const double around_rad = std::atan2(along.y(), along.x());
  return ellipsoid(0.5 * (from + to), {thickness, thickness, 0.5 * along.norm() + 0.6 * thickness},
                   {0.0, down_rad, around_rad});
}

Bodies figure() {
  Bodies bodies{ellipsoid({0.0, 0.0, 0.62}, {0.22, 0.27, 0.33}), ellipsoid({-0.05, 0.0, 0.98}, {0.15, 0.14, 0.16}),
                ellipsoid({0.12, 0.0, 0.94}, {0.13, 0.07, 0.07}), limb({-0.15, 0.0, 0.5}, {-0.55, 0.0, 0.12}, 0.07)};
  for (const double side : {-1.0, 1.0}) {
    bodies.push_back(limb({0.0, 0.22 * side, 0.82}, {0.12, 0.48 * side, 0.74}, 0.07));   // upper arm
    bodies.push_back(limb({0.12, 0.48 * side, 0.74}, {0.26, 0.52 * side, 1.02}, 0.06));  // lower arm, raised
    bodies.push_back(ellipsoid({0.28, 0.52 * side, 1.09}, {0.07, 0.05, 0.09}));          // hand
    bodies.push_back(limb({0.0, 0.14 * side, 0.42}, {0.16, 0.2 * side, 0.2}, 0.11));     // thigh
    bodies.push_back(limb({0.16, 0.2 * side, 0.2}, {0.02, 0.22 * side, 0.06}, 0.08));    // shin
    bodies.push_back(ellipsoid({0.1, 0.23 * side, 0.04}, {0.15, 0.08, 0.04}));           // foot
    bodies.push_back(ellipsoid({-0.1, 0.12 * side, 1.14}, {0.03, 0.06, 0.14}, {-0.35 * side, 0.0, 0.0}));  // ear
  }
  return bodies;
}

Bodies hare() {
  Bodies bodies{ellipsoid({0.0, 0.0, 0.33}, {0.42, 0.28, 0.3}, {0.0, -0.25, 0.0}),
                ellipsoid({0.28, 0.0, 0.55}, {0.19, 0.17, 0.24}), ellipsoid({0.38, 0.0, 0.78}, {0.19, 0.14, 0.15}),
                ellipsoid({-0.43, 0.0, 0.24}, {0.1, 0.1, 0.1})};
  for (const double side : {-1.0, 1.0}) {
    bodies.push_back(ellipsoid({0.22, 0.11 * side, 1.03}, {0.05, 0.08, 0.24}, {-0.2 * side, -0.35, 0.0}));  // ear
    bodies.push_back(ellipsoid({-0.12, 0.24 * side, 0.2}, {0.22, 0.12, 0.2}));                              // haunch
    bodies.push_back(ellipsoid({0.05, 0.26 * side, 0.04}, {0.2, 0.07, 0.05}));                              // hind foot
    bodies.push_back(limb({0.36, 0.1 * side, 0.4}, {0.44, 0.1 * side, 0.05}, 0.06));                        // fore leg
  }
  return bodies;
}

Bodies coil() {
  constexpr int kBalls{44};
  Bodies bodies;
  for (int i = 0; i < kBalls; ++i) {
    const double share = static_cast<double>(i) / (kBalls - 1);
    const double around_rad = 720_deg * share;
    const double reach = 0.42 - 0.12 * share;
    const double thickness = 0.13 - 0.05 * share;
    bodies.push_back(ellipsoid({reach * std::cos(around_rad), reach * std::sin(around_rad), 0.13 + 0.75 * share},
                               Vector3d::Constant(thickness)));
  }
  bodies.push_back(ellipsoid({0.42, -0.08, 0.92}, {0.1, 0.16, 0.1}));  // head
  return bodies;
}

Result<Bodies> jug() {
  const RevolutionShape body{{{0.30, 0.0}, {0.42, 0.3}, {0.40, 0.6}, {0.25, 0.85}, {0.30, 1.0}}, 0.03};
  SACCADE_TRY(TriangleMesh mesh, tessellate(JugShape{body, 0.25, 0.75, 0.22, 0.05}, 2e-3));
  return Bodies{std::move(mesh)};
}

}  // namespace

Result<Bodies> stand_in(std::string_view name) {
  if (name == "figure") return figure();
  if (name == "hare") return hare();
  if (name == "coil") return coil();
  if (name == "jug") return jug();
  return Error{Errc::invalid_argument, "there is no stand-in \"" + std::string{name} + "\"", "benchmark"};
}

}  // namespace saccade
