// SPDX-License-Identifier: Apache-2.0
#pragma once
// ObjectShape: height and axes of an object, of its true surface or as a mesh of the scene has it (thesis §2.4.1).
// Definitions: docs/metrics.md.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/scene/mesh_distance.hpp"
#include "saccade/scene/ray_scene.hpp"

namespace saccade {

/// The parameters that thesis §2.4.1 compares.
struct ObjectShape {
  double height_m{0.0};  ///< above the lowest point of the true object
  double major_m{0.0};   ///< width of the projection along z, across the minor axis
  double minor_m{0.0};   ///< its least width
};

struct ObjectShapeConfig {
  double reach_m{0.03};     ///< what is farther from the true object is not the object
  double trimmed_m2{1e-4};  ///< of the surface, the farthest out in each direction that does not count
  double spacing_m{0.0025};
  double least_share{0.1};  ///< of the true object's area; with less of it, nothing is measured

  /// invalid_argument for lengths and areas that are not positive, or a share outside [0, 1].
  [[nodiscard]] Status validate() const;
};

/// Shapes of the objects of a scene, supports excluded. Cheap to copy, safe for concurrent use.
class ObjectShapes {
 public:
  /// Measures the true objects. Errors: those of ObjectShapeConfig::validate and MeshDistance::build, and
  /// invalid_argument for an object with less surface than is trimmed.
  [[nodiscard]] static Result<ObjectShapes> build(const RayScene& scene, const ObjectShapeConfig& config = {});

  /// The objects that are no supports, as indices into Scene::objects.
  [[nodiscard]] const std::vector<std::size_t>& objects() const { return objects_; }
  /// Expects one of objects().
  [[nodiscard]] const ObjectShape& true_shape(std::size_t object) const;
  /// The object's part of a mesh of the scene: points of it within reach of the true object and nearer to it than to
  /// any other surface. Expects one of objects().
  /// @return nullopt where that part is too small. O(points · log triangles + points · directions), the same for every
  ///         thread count.
  [[nodiscard]] std::optional<ObjectShape> measure(std::size_t object, const TriangleMesh& mesh,
                                                   const Executor& executor) const;

 private:
  struct Measured {
    std::size_t object;
    double base_z_m;
    std::size_t points;  ///< of the true surface
    ObjectShape shape;
  };
  ObjectShapes(RayScene scene, const ObjectShapeConfig& config) : scene_{std::move(scene)}, config_{config} {}
  [[nodiscard]] const Measured& of(std::size_t object) const;
  [[nodiscard]] ObjectShape shape_of(const std::vector<Eigen::Vector3f>& points, double base_z_m) const;

  RayScene scene_;
  ObjectShapeConfig config_;
  std::vector<MeshDistance> surfaces_;  ///< of all objects, supports too
  std::vector<std::size_t> objects_;
  std::vector<Measured> measured_;
};

/// measured − truth, parameter by parameter.
[[nodiscard]] ObjectShape shape_error(const ObjectShape& measured, const ObjectShape& truth);

/// Over all parameters of all objects, as in Tables 2.1 and 2.7.
struct ShapeErrors {
  std::size_t parameters{0};
  double mean_abs_m{0.0};
  double standard_deviation_m{0.0};  ///< of the signed errors, with n − 1; 0 for fewer than two
};
[[nodiscard]] ShapeErrors summarize(std::span<const ObjectShape> errors);

}  // namespace saccade
