// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/arm_mesh.hpp"

#include <cmath>
#include <numbers>

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kSides{24};
constexpr std::uint32_t kRings{12};  ///< rings of a sphere, pole to pole

struct SurfaceOf {
  TriangleMesh operator()(const BoxBody& box) const {
    TriangleMesh mesh;
    const Vector3d half = 0.5 * box.size_m;
    for (unsigned i = 0; i < 8; ++i) {
      const Vector3d sign{(i & 1U) != 0 ? 1.0 : -1.0, (i & 2U) != 0 ? 1.0 : -1.0, (i & 4U) != 0 ? 1.0 : -1.0};
      mesh.vertices.push_back(sign.cwiseProduct(half).cast<float>());
    }
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
  }

  TriangleMesh operator()(const CylinderBody& cylinder) const {
    const double radius_m = cylinder.radius_m / std::cos(std::numbers::pi / kSides);
    return turned({{radius_m, -0.5 * cylinder.length_m}, {radius_m, 0.5 * cylinder.length_m}}, -0.5 * cylinder.length_m,
                  0.5 * cylinder.length_m);
  }

  TriangleMesh operator()(const SphereBody& sphere) const {
    // Rings of vertices on a larger sphere, so that the flat parts between them stay outside.
    const double radius_m =
        sphere.radius_m / (std::cos(std::numbers::pi / kSides) * std::cos(0.5 * std::numbers::pi / kRings));
    std::vector<std::pair<double, double>> profile;
    for (std::uint32_t i = 1; i < kRings; ++i) {
      const double angle_rad = std::numbers::pi * i / kRings;
      profile.emplace_back(radius_m * std::sin(angle_rad), -radius_m * std::cos(angle_rad));
    }
    return turned(profile, -radius_m, radius_m);
  }

  TriangleMesh operator()(const MeshBody& body) const {
    TriangleMesh mesh;
    mesh.vertices = body.mesh.vertices;
    mesh.triangles = body.mesh.triangles;
    return mesh;
  }

 private:
  /// Revolves a profile of (radius, z), low to high, about the z axis, closed by two points on it.
  static TriangleMesh turned(const std::vector<std::pair<double, double>>& profile, double low, double high) {
    TriangleMesh mesh;
    for (const auto& [radius_m, z] : profile) {
      for (std::uint32_t side = 0; side < kSides; ++side) {
        const double angle_rad = 2.0 * std::numbers::pi * side / kSides;
        mesh.vertices.push_back(
            Vector3d{radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), z}.cast<float>());
      }
    }
    const auto bottom = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(Vector3d{0.0, 0.0, low}.cast<float>());
    mesh.vertices.push_back(Vector3d{0.0, 0.0, high}.cast<float>());
    const auto last = static_cast<std::uint32_t>(profile.size() - 1) * kSides;
    for (std::uint32_t side = 0; side < kSides; ++side) {
      const std::uint32_t next = (side + 1) % kSides;
      mesh.triangles.push_back({bottom, next, side});
      mesh.triangles.push_back({bottom + 1, last + side, last + next});
      for (std::uint32_t ring = 0; ring < last; ring += kSides) {
        mesh.triangles.push_back({ring + side, ring + next, ring + kSides + side});
        mesh.triangles.push_back({ring + next, ring + kSides + next, ring + kSides + side});
      }
    }
    return mesh;
  }
};

}  // namespace

TriangleMesh body_surface(const CollisionBody& body) {
  TriangleMesh mesh = std::visit(SurfaceOf{}, body.shape);
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = (body.T_link_body * vertex.cast<double>()).cast<float>();
  return mesh;
}

}  // namespace saccade
