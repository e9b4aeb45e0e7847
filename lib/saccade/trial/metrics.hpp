// SPDX-License-Identifier: Apache-2.0
#pragma once
// GroundTruth and Metrics: how complete and accurate a map is, for a scene with known surfaces. RegionCoverage,
// ObjectShape (thesis §2.4.1), count_contacts. Definitions: docs/reference/metrics.md.

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "saccade/arm/arm_collision.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/region.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/robot/trajectory.hpp"
#include "saccade/scene/ray_scene.hpp"
#include "saccade/scene/solids.hpp"
#include "saccade/scene/surface_samples.hpp"

namespace saccade {

/// Default distance between samples of the true surfaces.
constexpr double kTruthSpacing_m{0.004};

class SpaceNearObjects;

/// Reference for maps of a scene. Cheap to copy; const use from many threads is safe.
class GroundTruth {
 public:
  /// Samples the surfaces, one point per spacing_m², and determines which points are observable. Answers
  /// invalid_argument for a spacing that is not positive or a scene of supports only. Cost: observable().
  [[nodiscard]] static Result<GroundTruth> build(const RayScene& scene, double spacing_m, const Executor& executor);

  [[nodiscard]] const RayScene& scene() const { return data_->scene; }
  /// Returns the observable points of the objects (without supports) in the workspace.
  [[nodiscard]] const std::vector<Eigen::Vector3f>& observable_points() const { return data_->observable_points; }
  /// Returns one outward normal per point.
  [[nodiscard]] const std::vector<Eigen::Vector3f>& observable_normals() const { return data_->observable_normals; }
  [[nodiscard]] double spacing_m() const { return data_->spacing_m; }

  /// Return the distance to the nearest surface of an object, or of a support; beyond_m where none is nearer.
  [[nodiscard]] double to_objects_m(const Eigen::Vector3d& p, double beyond_m) const;
  [[nodiscard]] double to_supports_m(const Eigen::Vector3d& p, double beyond_m) const;
  /// Return these distances of many points (MeshDistance::distances_m).
  [[nodiscard]] std::vector<double> to_objects_m(std::span<const Eigen::Vector3f> points, double beyond_m,
                                                 const Executor& executor) const;
  [[nodiscard]] std::vector<double> to_supports_m(std::span<const Eigen::Vector3f> points, double beyond_m,
                                                  const Executor& executor) const;
  /// Tells whether p lies inside any object or support.
  [[nodiscard]] bool inside_solid(const Eigen::Vector3d& p) const;
  /// Returns the voxels that unknown_near_objects counts where they are unknown. Finds them at the first call for a
  /// size of voxels, and keeps those of the last size.
  [[nodiscard]] std::shared_ptr<const SpaceNearObjects> space_near_objects(double voxel_size_m,
                                                                           const Executor& executor) const;

 private:
  struct Kept;
  [[nodiscard]] static std::shared_ptr<Kept> nothing_kept();
  struct Data {
    RayScene scene;
    Solids bodies;
    double spacing_m;
    std::vector<Eigen::Vector3f> observable_points;
    std::vector<Eigen::Vector3f> observable_normals;
    MeshDistance objects;
    std::optional<MeshDistance> supports;
    std::shared_ptr<Kept> kept;
  };
  explicit GroundTruth(std::shared_ptr<const Data> data) : data_{std::move(data)} {}
  std::shared_ptr<const Data> data_;
};

struct Metrics {
  double coverage{0.0};                 ///< share of the observable points within one voxel of the mesh
  std::size_t unknown_near_objects{0};  ///< voxels
  /// nullopt where the whole mesh lies on supports.
  std::optional<double> accuracy_m;
  std::optional<double> chamfer_m;
  std::optional<double> f_score;  ///< at 5 mm
};

/// Distances within which a point counts.
constexpr double kFScoreDistance_m{0.005};
constexpr double kNearObjects_m{0.03};

/// Measures a map and the mesh extracted from it. O(samples · log triangles + voxels near the objects). The thread
/// count changes no bit.
[[nodiscard]] Metrics measure(const GroundTruth& truth, const TsdfSnapshot& map, const TriangleMesh& mesh,
                              const Executor& executor);

/// Measures a mesh alone; unknown_near_objects stays 0. A point is covered within within_m of the mesh, and a point of
/// the mesh lies on a support within that distance of it. O(samples · log triangles). The thread count changes no bit.
[[nodiscard]] Metrics measure_mesh(const GroundTruth& truth, const TriangleMesh& mesh, double within_m,
                                   const Executor& executor);

/// Unknown voxels in the workspace outside the solids, their centre within kNearObjects_m of an object's surface.
/// O(bricks near the objects), after GroundTruth::space_near_objects.
[[nodiscard]] std::size_t unknown_near_objects(const GroundTruth& truth, const TsdfSnapshot& map,
                                               const Executor& executor);

/// Space made known by one view.
struct ObservedGain {
  std::size_t voxels{0};
  std::size_t near_objects{0};  ///< voxels among these with the centre within kAtObject_m of an object's surface

  /// Tells whether at least a quarter of the newly known voxels lies at objects, so that the view showed one.
  [[nodiscard]] bool reveals_object() const { return voxels > 0 && 4 * near_objects >= voxels; }
  ObservedGain& operator+=(const ObservedGain& other) {
    voxels += other.voxels;
    near_objects += other.near_objects;
    return *this;
  }
  [[nodiscard]] ObservedGain operator+(const ObservedGain& other) const { return ObservedGain{*this} += other; }
};
constexpr double kAtObject_m{0.05};

/// Tells whether the optical axis comes within kAtObject_m of an object before it meets anything: the view points at an
/// object, whatever it made known. Thesis Table 3.3. O(log triangles per centimetre of the axis in the workspace).
[[nodiscard]] bool looks_at_object(const GroundTruth& truth, const Pose& T_world_camera);

/// Compares the map before and after a view, within the workspace. O(bricks of the workspace + voxels at 5 cm from an
/// object · log triangles).
[[nodiscard]] ObservedGain newly_known(const GroundTruth& truth, const TsdfSnapshot& before, const TsdfSnapshot& after,
                                       const Executor& executor);

/// Observable part of the true surfaces in a region and the workspace.
struct RegionSurface {
  std::vector<Eigen::Vector3f> of_objects;
  std::vector<Eigen::Vector3f> of_supports;
};

/// Samples the true surfaces as GroundTruth::build does, and determines which points in the region are observable;
/// there may be none. Answers invalid_argument for a spacing that is not positive or a bad region. Cost: observable()
/// for the points in the region.
[[nodiscard]] Result<RegionSurface> observable_in(const RayScene& scene, const Region& region, double spacing_m,
                                                  const Executor& executor);

/// Shares of observable points within a distance of the mesh; nullopt without such points.
struct RegionCoverage {
  std::optional<double> objects;   ///< without supports
  std::optional<double> surfaces;  ///< objects and supports together
};

/// Compares a mesh with the surface in a region; a mesh without triangles covers nothing. Expects indices within range
/// and a positive distance. O(triangles · log triangles + points · log triangles). The thread count never changes the
/// result.
[[nodiscard]] RegionCoverage measure_coverage(const RegionSurface& truth, const TriangleMesh& mesh, double within_m,
                                              const Executor& executor);
/// Compares with a prebuilt distance to the mesh, for several regions. Null: it has no triangles.
[[nodiscard]] RegionCoverage measure_coverage(const RegionSurface& truth, const MeshDistance* mesh, double within_m,
                                              const Executor& executor);

/// Parameters that thesis §2.4.1 compares.
struct ObjectShape {
  double height_m{0.0};  ///< above the lowest point of the true object
  double major_m{0.0};   ///< width of the projection along z, across the minor axis
  double minor_m{0.0};   ///< smallest width of the projection
};

struct ObjectShapeConfig {
  double reach_m{0.03};     ///< points farther from the true object do not belong to it
  double trimmed_m2{1e-4};  ///< area of the outermost surface in each direction that is ignored
  double spacing_m{0.0025};
  double least_share{0.1};  ///< share of the true object's area that is required for a measurement

  /// Answers invalid_argument for lengths and areas that are not positive, or a share outside [0, 1].
  [[nodiscard]] Status validate() const;
};

/// Shapes of the objects of a scene, without supports. Cheap to copy, safe for concurrent use.
class ObjectShapes {
 public:
  /// Measures the true objects. Errors: those of ObjectShapeConfig::validate and MeshDistance::build, and
  /// invalid_argument for an object with less surface than is trimmed.
  [[nodiscard]] static Result<ObjectShapes> build(const RayScene& scene, const ObjectShapeConfig& config = {});

  /// Returns the objects, without supports, as indices into Scene::objects.
  [[nodiscard]] const std::vector<std::size_t>& objects() const { return objects_; }
  /// Returns the true shape. Expects one of objects().
  [[nodiscard]] const ObjectShape& true_shape(std::size_t object) const;
  /// Measures the object's part of a mesh of the scene: points within reach of the true object and nearer to it than to
  /// any other surface. Expects one of objects().
  /// @return nullopt where that part is too small. O(points · log triangles + points · directions). The thread count
  /// never changes the result.
  [[nodiscard]] std::optional<ObjectShape> measure(std::size_t object, const TriangleMesh& mesh,
                                                   const Executor& executor) const;

 private:
  struct Measured {
    std::size_t object;
    double base_z_m;
    std::size_t points;  ///< points on the true surface
    ObjectShape shape;
  };
  ObjectShapes(RayScene scene, const ObjectShapeConfig& config) : scene_{std::move(scene)}, config_{config} {}
  [[nodiscard]] const Measured& of(std::size_t object) const;
  [[nodiscard]] ObjectShape shape_of(const std::vector<Eigen::Vector3f>& points, double base_z_m) const;

  RayScene scene_;
  ObjectShapeConfig config_;
  std::vector<MeshDistance> surfaces_;  ///< surfaces of all objects, including supports
  std::vector<std::size_t> objects_;
  std::vector<Measured> measured_;
};

/// Returns measured − truth for each parameter.
[[nodiscard]] ObjectShape shape_error(const ObjectShape& measured, const ObjectShape& truth);

/// Errors over all parameters of all objects, as in Tables 2.1 and 2.7.
struct ShapeErrors {
  std::size_t parameters{0};
  double mean_abs_m{0.0};
  double standard_deviation_m{0.0};  ///< deviation of the signed errors, with n − 1; 0 for fewer than two
};
[[nodiscard]] ShapeErrors summarize(std::span<const ObjectShape> errors);

/// Tells whether a link of the arm penetrates a solid. The links are taken as their balls in ArmCollision; the finest
/// are shrunk by 5 mm, by which they may exceed the links.
[[nodiscard]] bool touches(const ArmCollision& collision, const Solids& solids, const Configuration& q);
/// Counts the instants of the motions, one every step_s, at which a link touches a solid.
/// O(instants · balls near something · log triangles)
[[nodiscard]] std::size_t count_contacts(const ArmCollision& collision, const Solids& solids,
                                         std::span<const Trajectory> motions, const Executor& executor,
                                         double step_s = 0.03);

}  // namespace saccade
