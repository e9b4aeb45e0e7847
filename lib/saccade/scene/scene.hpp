// SPDX-License-Identifier: Apache-2.0
#pragma once
// Scene: named objects with poses, colours and textures, and the settings of an exploration. Shape: the objects'
// bodies. Patch: painted parts. random_clutter,
// random_room, random_street: scenes drawn from a seed.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "saccade/core/names.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/core/region.hpp"
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

/// Superquadric (|x/a|^(2/e₂) + |y/b|^(2/e₂))^(e₂/e₁) + |z/c|^(2/e₁) ≤ 1 (Barr 1981). Exponents 1 and 1 make an
/// ellipsoid, small ones a box with rounded edges, 2 and 2 an octahedron.
struct SuperquadricShape {
  Eigen::Vector3d semi_axes_m{Eigen::Vector3d::Zero()};
  double vertical_exponent{1.0};    ///< e₁, within 0.1 and 2
  double horizontal_exponent{1.0};  ///< e₂, within 0.1 and 2
};

/// Profile of (radius, height) points, lowest first, revolved around the z axis. With a wall, it is a vessel: open at
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
  double handle_reach_m{0.0};  ///< distance of the bar's axis from the body
  double handle_radius_m{0.0};
};

/// Triangles in the object's frame, used unchanged.
struct MeshShape {
  TriangleMesh mesh;
};

using Shape = std::variant<BoxShape, CylinderShape, SphereShape, ConeShape, SuperquadricShape, RevolutionShape,
                           JugShape, MeshShape>;

/// Answers invalid_argument when a size is not finite, zero or negative, a profile does not rise or leaves no room for
/// its wall, a handle does not sit within the wall, or a mesh has no triangles or invalid indices.
[[nodiscard]] Status validate(const Shape& shape);

/// Returns a closed mesh, counter-clockwise seen from outside, without normals or colours. A jug is two closed parts,
/// with the bar's ends inside the wall. Circles and spheres stay within max_deviation_m of the true ones; superquadrics
/// are at least as fine as such an ellipsoid. A MeshShape is returned unchanged. Errors: those of validate, and a
/// deviation that is not positive. O(triangles).
[[nodiscard]] Result<TriangleMesh> tessellate(const Shape& shape, double max_deviation_m = 1e-4);

/// Solid texture: a pattern through the body in its own frame, so that every face shows it.
struct Texture {
  enum class Kind { plain, checker, stripes, speckle };
  Kind kind{Kind::plain};
  double size_m{0.03};     ///< edge of a square, width of a stripe (along z), size of a speckle
  double darkening{0.55};  ///< brightness of the darker parts, relative to the colour
};
inline constexpr auto kTextureNames = make_names<Texture::Kind>({{Texture::Kind::plain, "plain"},
                                                                 {Texture::Kind::checker, "checker"},
                                                                 {Texture::Kind::stripes, "stripes"},
                                                                 {Texture::Kind::speckle, "speckle"}});

/// Paint on the faces of a body that look along one axis of its frame; it has no thickness. Later patches cover earlier
/// ones. Seen from outside, the faces ±x and ±y have z upwards and ±z has y upwards (−z: −y).
struct Patch {
  enum class Face { plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };
  /// `glyph` is a letter or a digit of 5×7 cells; `print` is lines of small print, which belong to the segment below.
  enum class Kind { rectangle, ellipse, glyph, print };
  Face face{Face::plus_z};
  Kind kind{Kind::rectangle};
  Eigen::Vector2d center_m{Eigen::Vector2d::Zero()};  ///< to the right and upwards, from the frame's origin
  Eigen::Vector2d size_m{0.1, 0.1};
  Rgb8 color{40, 40, 40};
  char glyph{'A'};       ///< A to Z, 0 to 9
  double line_m{0.004};  ///< line spacing of print
  std::string segment;   ///< segment name that an annotator would use; not used by print
};

struct SceneObject {
  std::string name;
  Shape shape;
  Pose T_world_object{Pose::Identity()};
  Rgb8 color{200, 200, 200};
  Texture texture{};
  std::string segment{};         ///< true segment of its unpainted surface; empty: its name
  std::vector<Patch> patches{};  ///< painted parts
  bool support{false};           ///< surface that objects stand on or lean at, such as a table or a wall; no object of
                                 ///< interest
  bool fixture{false};           ///< known beforehand: the robot avoids it
};

/// Lengths in metres, world frame with z up.
struct Scene {
  std::string name;
  std::vector<SceneObject> objects;
  Box workspace;                 ///< space that counts as unknown until it is seen
  std::vector<Region> regions;   ///< regions to explore; none: the whole workspace
  std::vector<Pose> scan;        ///< camera poses of the initial scan
  double max_deviation_m{1e-4};  ///< tolerance of the tessellation

  /// Answers invalid_argument, naming the object: a bad shape, texture or pose, a name that is empty or not unique; an
  /// empty workspace, a bad region, or a region outside the workspace. A cell with a real camera has no objects.
  [[nodiscard]] Status validate() const;
};

/// Triangles of one object, world frame.
struct ObjectMesh {
  std::string name;
  TriangleMesh mesh;
  bool support{false};
};

/// Returns the true surfaces, one mesh per object in the scene's order. Errors: those of Scene::validate, and
/// invalid_argument for a scene without objects or an object that reaches farther than a kilometre from the origin.
/// O(triangles).
[[nodiscard]] Result<std::vector<ObjectMesh>> true_meshes(const Scene& scene);

/// Returns the colour of a point of the object's surface, before lighting.
[[nodiscard]] Rgb8 surface_color(const SceneObject& object, const Eigen::Vector3d& p_object);

/// Answers invalid_argument for sizes that are not positive, an unknown glyph, or a patch without a segment.
[[nodiscard]] Status validate(const Patch& patch);

struct Paint {
  Rgb8 color{};                  ///< before lighting
  std::size_t segment_patch{0};  ///< 1 + index of the patch that gives the segment; 0: the body
  bool fine{false};              ///< within small print: a pixel needs more than one ray
};

/// Returns the paint at a point of the object's surface; point and normal in the object's frame. O(patches).
[[nodiscard]] Paint paint_at(const SceneObject& object, const Eigen::Vector3d& p_object,
                             const Eigen::Vector3d& normal_object);

/// True segments of a scene, numbered from 1 in the order of its objects and their patches. Segments with equal names
/// are one segment.
class SegmentTable {
 public:
  explicit SegmentTable(const Scene& scene);
  /// Returns the names by label. Label 0 is nothing; its name is empty.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// Returns the label of a paint. Expects an object of the scene, and a Paint on it.
  [[nodiscard]] std::uint16_t label(std::size_t object, const Paint& paint) const {
    return labels_[object][paint.segment_patch];
  }

 private:
  std::vector<std::string> names_;
  std::vector<std::vector<std::uint16_t>> labels_;  ///< per object: the body, then its patches
};

/// Object that is a fixture or a support.
struct FixtureBox {
  std::string name;
  Box box;
  bool support{false};
};

/// Returns the axis-aligned bounding boxes of a scene's fixtures and supports, in the scene's order. A leaning object
/// gets more room than it occupies. Coordinates are whole micrometres; no side is shorter than a millimetre. Errors:
/// those of true_meshes.
[[nodiscard]] Result<std::vector<FixtureBox>> fixture_boxes(const Scene& scene);

/// Draws a scene: bodies of every procedural kind, standing apart on a table of 1.2 × 0.8 m with its top at z = 0 in a
/// room, and an initial scan from one side of the table. 1 ≤ objects ≤ 16; fewer are placed when the table is full.
/// Equal on every machine.
[[nodiscard]] Scene random_clutter(std::uint64_t seed, int objects = 8);

/// Draw a furnished room of 4 to 6 by 3.6 to 5 m, and a street of 56 m between houses, for scans to label
/// (laser_scan.hpp): things of several bodies are one segment, and the poses of the initial scan are the scanner's
/// stations. Equal on every machine.
[[nodiscard]] Scene random_room(std::uint64_t seed);
[[nodiscard]] Scene random_street(std::uint64_t seed);

}  // namespace saccade
