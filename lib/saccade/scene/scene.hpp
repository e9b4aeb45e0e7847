// SPDX-License-Identifier: Apache-2.0
#pragma once
// Scene: named objects with poses, colours and textures, and what an exploration of it is told.

#include <string>
#include <vector>

#include "saccade/core/names.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/core/region.hpp"
#include "saccade/scene/shape.hpp"

namespace saccade {

/// A pattern through the body, in its own frame, so that every face has some.
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

/// Something painted on the faces of a body that look along one axis of its frame; it has no thickness. Later ones
/// cover earlier ones. Seen from outside, the faces ±x and ±y have z upwards and ±z has y upwards (−z: −y).
struct Patch {
  enum class Face { plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };
  /// `glyph` is a letter or a digit of 5×7 cells; `print` is lines of small print, of the segment that it is on.
  enum class Kind { rectangle, ellipse, glyph, print };
  Face face{Face::plus_z};
  Kind kind{Kind::rectangle};
  Eigen::Vector2d center_m{Eigen::Vector2d::Zero()};  ///< to the right and upwards, from the frame's origin
  Eigen::Vector2d size_m{0.1, 0.1};
  Rgb8 color{40, 40, 40};
  char glyph{'A'};       ///< A to Z, 0 to 9
  double line_m{0.004};  ///< from line to line of print
  std::string segment;   ///< what an annotator would call it; not used by print
};

struct SceneObject {
  std::string name;
  Shape shape;
  Pose T_world_object{Pose::Identity()};
  Rgb8 color{200, 200, 200};
  Texture texture{};
  std::string segment{};         ///< the true segment of its unpainted surface; empty: its name
  std::vector<Patch> patches{};  ///< what is painted on it
  bool support{false};           ///< what objects stand on or lean at, such as a table or a wall; no object of interest
  bool fixture{false};           ///< known beforehand: what moves the camera keeps clear of it
};

/// Lengths in metres, world frame with z up.
struct Scene {
  std::string name;
  std::vector<SceneObject> objects;
  Box workspace;                 ///< where space counts as unknown until it is seen
  std::vector<Region> regions;   ///< where to look; none: the whole workspace
  std::vector<Pose> scan;        ///< camera poses of the initial scan
  double max_deviation_m{1e-4};  ///< of the tessellation

  /// invalid_argument, naming the object: a bad shape, texture or pose, a name that is empty or not unique; an empty
  /// workspace, a bad region, or a region outside the workspace. A cell with a real camera has no objects.
  [[nodiscard]] Status validate() const;
};

/// The triangles of one object, world frame.
struct ObjectMesh {
  std::string name;
  TriangleMesh mesh;
  bool support{false};
};

/// The true surfaces, one mesh per object in the scene's order. Errors: those of Scene::validate, and
/// invalid_argument for a scene without objects or an object that reaches farther than a kilometre from the origin.
/// O(triangles).
[[nodiscard]] Result<std::vector<ObjectMesh>> true_meshes(const Scene& scene);

/// Colour of a point of the object's surface, before lighting.
[[nodiscard]] Rgb8 surface_color(const SceneObject& object, const Eigen::Vector3d& p_object);

}  // namespace saccade
