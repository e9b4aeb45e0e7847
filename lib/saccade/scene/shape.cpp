// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "saccade/scene/internal/lathe.hpp"

namespace saccade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi{std::numbers::pi};

Error refused(const char* what) { return Error{Errc::invalid_argument, what, "shape"}; }

bool positive(double value) { return std::isfinite(value) && value > 0.0; }

Status check(const BoxShape& box) {
  if (!(box.size_m.allFinite() && box.size_m.minCoeff() > 0.0)) return refused("a box needs three positive sizes");
  return {};
}

Status check(const CylinderShape& cylinder) {
  if (positive(cylinder.radius_m) && positive(cylinder.height_m)) return {};
  return refused("a cylinder needs a positive radius and height");
}

Status check(const SphereShape& sphere) {
  if (positive(sphere.radius_m)) return {};
  return refused("a sphere needs a positive radius");
}

Status check(const ConeShape& cone) {
  const bool top = std::isfinite(cone.top_radius_m) && cone.top_radius_m >= 0.0;
  if (top && positive(cone.bottom_radius_m) && positive(cone.height_m)) return {};
  return refused("a cone needs a positive bottom radius and height, and a top radius that is not negative");
}

Status check(const SuperquadricShape& body) {
  const auto exponent = [](double e) { return e >= 0.1 && e <= 2.0; };
  if (!(body.semi_axes_m.allFinite() && body.semi_axes_m.minCoeff() > 0.0)) {
    return refused("a superquadric needs three positive semi-axes");
  }
  if (exponent(body.vertical_exponent) && exponent(body.horizontal_exponent)) return {};
  return refused("the exponents of a superquadric are within 0.1 and 2");
}

Status check(const RevolutionShape& body) {
  const std::vector<Vector2d>& profile = body.profile_m;
  if (profile.size() < 2) return refused("a profile needs two points or more");
  for (std::size_t i = 0; i < profile.size(); ++i) {
    if (!profile[i].allFinite() || profile[i].x() < 0.0) return refused("the radii of a profile must not be negative");
    if (i > 0 && profile[i].y() < profile[i - 1].y()) return refused("a profile goes up from its lowest point");
  }
  const auto widest = std::max_element(profile.begin(), profile.end(),
                                       [](const Vector2d& a, const Vector2d& b) { return a.x() < b.x(); });
  const double height_m = profile.back().y() - profile.front().y();
  if (!positive(widest->x()) || !positive(height_m)) return refused("a profile needs a width and a height");
  if (!(std::isfinite(body.wall_m) && body.wall_m >= 0.0)) return refused("a wall must not be negative");
  if (body.wall_m == 0.0) return {};
  if (body.wall_m >= height_m) return refused("the wall leaves no room inside the profile");
  for (const Vector2d& point : profile) {
    if (point.x() <= body.wall_m) return refused("the wall leaves no room inside the profile");
  }
  return {};
}

Status check(const JugShape& jug) {
  SACCADE_CHECK(check(jug.body));
  if (jug.body.wall_m == 0.0) return refused("a jug needs a wall");
  if (!positive(jug.handle_radius_m) || !positive(jug.handle_reach_m)) {
    return refused("a handle needs a positive reach and radius");
  }
  const double low = jug.body.profile_m.front().y();
  const double high = jug.body.profile_m.back().y();
  if (!(jug.handle_bottom_m - jug.handle_radius_m >= low && jug.handle_top_m + jug.handle_radius_m <= high &&
        jug.handle_top_m - jug.handle_bottom_m > 2.0 * jug.handle_radius_m)) {
    return refused("a handle starts and ends on the body, its ends apart");
  }
  // The flat ends of the bar must not protrude into the vessel: they have half the wall's thickness.
  for (const double z : {jug.handle_bottom_m, jug.handle_top_m}) {
    const double body_radius_m = profile_radius_m(jug.body.profile_m, z);
    if (jug.handle_radius_m * jug.handle_radius_m >= body_radius_m * jug.body.wall_m) {
      return refused("the handle is too thick for the wall that it sits in");
    }
  }
  return {};
}

Status check(const MeshShape& shape) {
  const TriangleMesh& mesh = shape.mesh;
  if (mesh.triangles.empty()) return refused("a mesh needs triangles");
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    if (!vertex.allFinite()) return refused("a vertex of the mesh is not finite");
  }
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) {
      if (index >= mesh.vertices.size()) return refused("a triangle of the mesh names a vertex that is not there");
    }
  }
  return {};
}

TriangleMesh triangles_of(const BoxShape& box, double /*max_deviation_m*/) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d p{((corner & 1) != 0 ? 0.5 : -0.5) * box.size_m.x(),
                     ((corner & 2) != 0 ? 0.5 : -0.5) * box.size_m.y(), (corner & 4) != 0 ? box.size_m.z() : 0.0};
    mesh.vertices.push_back(p.cast<float>());
  }
  mesh.triangles = {{0, 3, 1}, {0, 2, 3}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 7, 3}, {2, 6, 7}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh triangles_of(const ConeShape& cone, double max_deviation_m) {
  const int sides = sides_of_circle(std::max(cone.bottom_radius_m, cone.top_radius_m), max_deviation_m);
  return turned({{0.0, 0.0}, {cone.bottom_radius_m, 0.0}, {cone.top_radius_m, cone.height_m}, {0.0, cone.height_m}},
                sides);
}

TriangleMesh triangles_of(const CylinderShape& cylinder, double max_deviation_m) {
  return triangles_of(ConeShape{cylinder.radius_m, cylinder.radius_m, cylinder.height_m}, max_deviation_m);
}

TriangleMesh triangles_of(const SphereShape& sphere, double max_deviation_m) {
  // Both directions deviate, so each gets half of the tolerance.
  const int sides = sides_of_circle(sphere.radius_m, 0.5 * max_deviation_m);
  const int rings = (sides + 1) / 2;
  std::vector<Vector2d> profile;
  for (int i = 0; i <= rings; ++i) {
    const double latitude_rad = kPi * (static_cast<double>(i) / rings - 0.5);
    const double radius = i == 0 || i == rings ? 0.0 : std::cos(latitude_rad);
    profile.push_back(sphere.radius_m * Vector2d{radius, 1.0 + std::sin(latitude_rad)});
  }
  return turned(profile, sides);
}

/// Returns the point of the superellipse |x|^(2/e) + |y|^(2/e) = 1 in a direction.
Vector2d on_superellipse(double angle_rad, double exponent) {
  const Vector2d direction{std::cos(angle_rad), std::sin(angle_rad)};
  const Vector2d powers = direction.cwiseAbs().array().pow(2.0 / exponent);
  return direction * std::pow(powers.sum(), -0.5 * exponent);
}

/// Tessellates as a sphere's grid moved onto the superquadric: the product of two superellipses (Barr 1981).
TriangleMesh triangles_of(const SuperquadricShape& body, double max_deviation_m) {
  constexpr int kFewestSides{128};  // needed for rounded edges, which the deviation of a circle does not bound
  const int sides =
      std::max(kFewestSides, 4 * ((sides_of_circle(body.semi_axes_m.maxCoeff(), 0.5 * max_deviation_m) + 3) / 4));
  const int rings = sides / 2;
  std::vector<Vector2d> profile;
  for (int ring = 0; ring <= rings; ++ring) profile.emplace_back(ring == 0 || ring == rings ? 0.0 : 1.0, ring);
  TriangleMesh mesh = turned(profile, sides);  // numbers its vertices ring by ring
  const auto place = [&](int ring, int side) {
    const Vector2d vertical = on_superellipse(kPi * (static_cast<double>(ring) / rings - 0.5), body.vertical_exponent);
    const Vector2d horizontal = on_superellipse(2.0 * kPi * side / sides, body.horizontal_exponent);
    const bool pole = ring == 0 || ring == rings;
    const double width = pole ? 0.0 : vertical.x();
    const Vector3d unit{width * horizontal.x(), width * horizontal.y(), 1.0 + vertical.y()};
    return Eigen::Vector3f{unit.cwiseProduct(body.semi_axes_m).cast<float>()};
  };
  std::size_t vertex = 0;
  for (int ring = 0; ring <= rings; ++ring) {
    const int count = ring == 0 || ring == rings ? 1 : sides;
    for (int side = 0; side < count; ++side) mesh.vertices[vertex++] = place(ring, side);
  }
  return mesh;
}

TriangleMesh triangles_of(const RevolutionShape& body, double max_deviation_m) {
  double widest_m = 0.0;
  for (const Vector2d& point : body.profile_m) widest_m = std::max(widest_m, point.x());
  const double bottom_m = body.profile_m.front().y();
  std::vector<Vector2d> outline{{0.0, bottom_m}};
  for (const Vector2d& point : body.profile_m) {
    if (point != outline.back()) outline.push_back(point);
  }
  if (body.wall_m > 0.0) {
    const double floor_m = bottom_m + body.wall_m;
    for (auto point = body.profile_m.rbegin(); point != body.profile_m.rend() && point->y() > floor_m; ++point) {
      outline.emplace_back(point->x() - body.wall_m, point->y());
    }
    outline.emplace_back(profile_radius_m(body.profile_m, floor_m) - body.wall_m, floor_m);
    outline.emplace_back(0.0, floor_m);
  } else if (outline.back().x() > 0.0) {
    outline.emplace_back(0.0, body.profile_m.back().y());
  }
  return turned(outline, sides_of_circle(widest_m, max_deviation_m));
}

TriangleMesh triangles_of(const JugShape& jug, double max_deviation_m) {
  TriangleMesh mesh = triangles_of(jug.body, max_deviation_m);
  const double half_wall_m = 0.5 * jug.body.wall_m;
  const double half_height_m = 0.5 * (jug.handle_top_m - jug.handle_bottom_m);
  const double middle_m = 0.5 * (jug.handle_top_m + jug.handle_bottom_m);
  const double from_m = profile_radius_m(jug.body.profile_m, jug.handle_bottom_m) - half_wall_m;
  const double to_m = profile_radius_m(jug.body.profile_m, jug.handle_top_m) - half_wall_m;
  const int steps = sides_of_circle(std::max(half_height_m, jug.handle_reach_m), 0.5 * max_deviation_m);
  std::vector<Vector2d> axis;
  for (int i = 0; i <= steps; ++i) {
    const double angle_rad = kPi * i / steps;
    const double share = 0.5 * (1.0 - std::cos(angle_rad));
    axis.emplace_back(from_m + share * (to_m - from_m) + (jug.handle_reach_m + half_wall_m) * std::sin(angle_rad),
                      middle_m - half_height_m * std::cos(angle_rad));
  }
  const TriangleMesh bar =
      bent_bar(axis, jug.handle_radius_m, sides_of_circle(jug.handle_radius_m, 0.5 * max_deviation_m));
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), bar.vertices.begin(), bar.vertices.end());
  for (const auto& [a, b, c] : bar.triangles) mesh.triangles.push_back({a + offset, b + offset, c + offset});
  return mesh;
}

TriangleMesh triangles_of(const MeshShape& shape, double /*max_deviation_m*/) { return shape.mesh; }

}  // namespace

Status validate(const Shape& shape) {
  return std::visit([](const auto& body) { return check(body); }, shape);
}

Result<TriangleMesh> tessellate(const Shape& shape, double max_deviation_m) {
  SACCADE_CHECK(validate(shape));
  if (!positive(max_deviation_m)) return refused("the deviation of a tessellation must be positive");
  return std::visit([&](const auto& body) { return triangles_of(body, max_deviation_m); }, shape);
}

}  // namespace saccade
