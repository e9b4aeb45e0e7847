// SPDX-License-Identifier: Apache-2.0
#pragma once
// Shape: the procedural bodies that scenes are made of, and meshes; tessellate turns any of them into triangles.

#include <Eigen/Core>
#include <variant>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/map/mesh.hpp"

namespace saccade {

// Every procedural body stands on the plane z = 0 of its own frame, around the z axis.

struct BoxShape {
  Eigen::Vector3d size_m{Eigen::Vector3d::Zero()};
};

struct CylinderShape {
  double radius_m{0.0};
  double height_m{0.0};
};

struct SphereShape {
  double radius_m{0.0};
};

/// A frustum; the top radius may be 0.
struct ConeShape {
  double bottom_radius_m{0.0};
  double top_radius_m{0.0};
  double height_m{0.0};
};

/// (|x/a|^(2/e₂) + |y/b|^(2/e₂))^(e₂/e₁) + |z/c|^(2/e₁) ≤ 1 (Barr 1981): exponents 1 and 1 make an ellipsoid, small
/// ones a box with rounded edges, 2 and 2 an octahedron.
struct SuperquadricShape {
  Eigen::Vector3d semi_axes_m{Eigen::Vector3d::Zero()};
  double vertical_exponent{1.0};    ///< e₁, within 0.1 and 2
  double horizontal_exponent{1.0};  ///< e₂, within 0.1 and 2
};

/// Turns a profile of (radius, height) points, lowest first, around the z axis. With a wall, it is a vessel: open at
/// the top, wall_m thick all around and at the bottom. Without, it is solid.
struct RevolutionShape {
  std::vector<Eigen::Vector2d> profile_m;
  double wall_m{0.0};
};

/// A vessel with a handle: half an ellipse of a round bar, from handle_bottom_m up to handle_top_m on the side of +x.
struct JugShape {
  RevolutionShape body;
  double handle_bottom_m{0.0};
  double handle_top_m{0.0};
  double handle_reach_m{0.0};  ///< how far the bar's axis stands off the body
  double handle_radius_m{0.0};
};

/// Triangles in the object's frame, as they are.
struct MeshShape {
  TriangleMesh mesh;
};

using Shape = std::variant<BoxShape, CylinderShape, SphereShape, ConeShape, SuperquadricShape, RevolutionShape,
                           JugShape, MeshShape>;

/// invalid_argument when a size is not finite, zero or negative, a profile does not rise or leaves no room for its
/// wall, a handle does not sit within the wall, or a mesh has no triangles or names vertices that it does not have.
[[nodiscard]] Status validate(const Shape& shape);

/// A closed mesh, counter-clockwise seen from outside, without normals or colours; a jug is two closed parts, the bar's
/// ends inside the wall. Circles and spheres stay within max_deviation_m of the true ones, superquadrics are at
/// least as fine as such an ellipsoid. A MeshShape is returned as it is.
/// Errors: those of validate, and a deviation that is not positive. O(triangles).
[[nodiscard]] Result<TriangleMesh> tessellate(const Shape& shape, double max_deviation_m = 1e-4);

}  // namespace saccade
