// SPDX-License-Identifier: Apache-2.0
#pragma once
// RayScene: the triangles of a Scene, ready for ray casting; rendering of exact depth, colour and labels. scene_hash:
// equal for scenes that a depth camera cannot tell apart.

#include <memory>
#include <optional>
#include <string>

#include "saccade/core/executor.hpp"
#include "saccade/scene/scene.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// First intersection of a ray with a surface, from outside or inside.
struct TriangleHit {
  double t{0.0};                                          ///< p = origin + t·direction
  Eigen::Vector3d normal_world{Eigen::Vector3d::Zero()};  ///< outward normal of the triangle, length 1
  Eigen::Vector2d barycentric{Eigen::Vector2d::Zero()};   ///< weights of the triangle's second and third vertex
  std::size_t object{0};
  std::size_t triangle{0};  ///< within the object's mesh
};

struct ExactFrame {
  DepthImage depth;               ///< metres along z; 0 where nothing is hit within the camera's range
  ColorImage color;               ///< Lambert shaded; black where depth is 0
  Image<int> object;              ///< index into Scene::objects; −1 where depth is 0
  Image<float> incidence_cosine;  ///< cosine of the angle between ray and normal; 0 where depth is 0
};

/// Ray casting scene: immutable, cheap to copy, safe for concurrent use. Embree finds a ray's triangle in single
/// precision; the distance to it is then computed in double precision.
class RayScene {
 public:
  /// Builds the scene. Errors: those of Scene::validate, and unavailable when Embree does not start. O(triangles · log
  /// triangles).
  [[nodiscard]] static Result<RayScene> build(Scene scene);

  [[nodiscard]] const Scene& scene() const;
  /// Returns the triangles, one mesh per object in the scene's order.
  [[nodiscard]] const std::vector<ObjectMesh>& meshes() const;

  /// Returns the nearest hit with t > 0 of origin + t·direction. Expects finite numbers and a direction that is not
  /// zero.
  [[nodiscard]] std::optional<TriangleHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

  /// Renders the view of a perfect camera, pixel (u, v) along the ray through (u, v). Expects a valid camera and a
  /// finite pose. O(pixels · log triangles). The thread count never changes the result.
  [[nodiscard]] ExactFrame render(const PinholeCamera& camera, const Pose& T_world_camera,
                                  const Executor& executor = {}) const;

 private:
  struct Impl;
  explicit RayScene(std::shared_ptr<const Impl> impl);
  std::shared_ptr<const Impl> impl_;
};

/// Returns 16 hexadecimal digits, a hash of everything that affects an exploration of the scene and its measurement:
/// triangles, supports and fixtures, workspace, regions, and the poses of the initial scan. Names, colours and textures
/// are excluded. A 64-bit FNV-1a hash: it detects mistakes, not forgeries. O(triangles).
[[nodiscard]] std::string scene_hash(const RayScene& scene);

}  // namespace saccade
