// SPDX-License-Identifier: Apache-2.0
#pragma once
// Truth and Metrics: how complete and how right a map is of a scene whose surfaces are known; RegionCoverage,
// ObjectShape (thesis §2.4.1), count_contacts. Definitions: docs/metrics.md.

#include <cstddef>
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

/// Distance between samples of the true surfaces, unless told otherwise.
constexpr double kTruthSpacing_m{0.004};

/// What maps of a scene are held against. Cheap to copy.
class Truth {
 public:
  /// Samples the surfaces, one point per spacing_m², and finds out which of them can be seen at all. invalid_argument
  /// for a spacing that is not positive or a scene of supports alone. Cost: observable().
  [[nodiscard]] static Result<Truth> build(const RayScene& scene, double spacing_m, const Executor& executor);

  [[nodiscard]] const RayScene& scene() const { return data_->scene; }
  /// Points of the objects (supports excluded) that lie in the workspace and can be seen.
  [[nodiscard]] const std::vector<Eigen::Vector3f>& observable_points() const { return data_->observable_points; }
  /// One per point, outward.
  [[nodiscard]] const std::vector<Eigen::Vector3f>& observable_normals() const { return data_->observable_normals; }
  [[nodiscard]] double spacing_m() const { return data_->spacing_m; }

  /// Distance to the nearest surface of an object, or of anything; beyond_m where there is none nearer.
  [[nodiscard]] double to_objects_m(const Eigen::Vector3d& p, double beyond_m) const;
  [[nodiscard]] double to_supports_m(const Eigen::Vector3d& p, double beyond_m) const;
  /// Whether p lies in the solid of any object or support.
  [[nodiscard]] bool inside_solid(const Eigen::Vector3d& p) const;

 private:
  struct Data {
    RayScene scene;
    Solids bodies;
    double spacing_m;
    std::vector<Eigen::Vector3f> observable_points;
    std::vector<Eigen::Vector3f> observable_normals;
    MeshDistance objects;
    std::optional<MeshDistance> supports;
  };
  explicit Truth(std::shared_ptr<const Data> data) : data_{std::move(data)} {}
  std::shared_ptr<const Data> data_;
};

struct Metrics {
  double coverage{0.0};                 ///< share of the observable points that the mesh has within one voxel
  std::size_t unknown_near_objects{0};  ///< voxels
  /// nullopt where the mesh has nothing off the supports.
  std::optional<double> accuracy_m;
  std::optional<double> chamfer_m;
  std::optional<double> f_score;  ///< at 5 mm
};

/// Distances up to which a point counts.
constexpr double kFScoreDistance_m{0.005};
constexpr double kNearObjects_m{0.03};

/// Measures a map and the mesh extracted from it. O(samples · log triangles + voxels near the objects). The thread
/// count changes no bit.
[[nodiscard]] Metrics measure(const Truth& truth, const TsdfSnapshot& map, const TriangleMesh& mesh,
                              const Executor& executor);

/// Unknown voxels in the workspace outside the solids, their centre within kNearObjects_m of an object's surface.
[[nodiscard]] std::size_t unknown_near_objects(const Truth& truth, const TsdfSnapshot& map, const Executor& executor);

/// What one view made known.
struct NewlyKnown {
  std::size_t voxels{0};
  std::size_t near_objects{0};  ///< of those, with the centre within kAtObject_m of an object's surface

  /// At least a quarter of what became known lies at objects: the view looked at one.
  [[nodiscard]] bool points_at_object() const { return voxels > 0 && 4 * near_objects >= voxels; }
};
constexpr double kAtObject_m{0.05};

/// Whether the optical axis comes within kAtObject_m of an object before it meets anything: the view points towards an
/// object, whatever it made known. Thesis Table 3.3. O(log triangles per centimetre of the axis in the workspace).
[[nodiscard]] bool looks_at_object(const Truth& truth, const Pose& T_world_camera);

/// Compares the map before and after a view, within the workspace. O(voxels of the workspace).
[[nodiscard]] NewlyKnown newly_known(const Truth& truth, const TsdfSnapshot& before, const TsdfSnapshot& after,
                                     const Executor& executor);

/// What can be seen of the true surfaces in a region and the workspace.
struct RegionSurface {
  std::vector<Eigen::Vector3f> of_objects;
  std::vector<Eigen::Vector3f> of_supports;
};

/// Samples the true surfaces as Truth::build does, and finds out which points in the region can be seen at all; there
/// may be none. invalid_argument for a spacing that is not positive or a bad region. Cost: observable() for the points
/// in the region.
[[nodiscard]] Result<RegionSurface> observable_in(const RayScene& scene, const Region& region, double spacing_m,
                                                  const Executor& executor);

/// Shares of observable points that the mesh has within a distance; nullopt where there are no such points.
struct RegionCoverage {
  std::optional<double> objects;   ///< supports left out
  std::optional<double> surfaces;  ///< of objects and supports together
};

/// Holds a mesh against the surface in a region; one without triangles has nothing of it. Expects indices within range
/// and a positive distance. O(triangles · log triangles + points · log triangles), the same for every thread count.
[[nodiscard]] RegionCoverage measure_coverage(const RegionSurface& truth, const TriangleMesh& mesh, double within_m,
                                              const Executor& executor);
/// The same for several regions: the distance to the mesh is built once. Null: it has no triangles.
[[nodiscard]] RegionCoverage measure_coverage(const RegionSurface& truth, const MeshDistance* mesh, double within_m,
                                              const Executor& executor);

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

/// Whether a link of the arm cuts into a solid. The links are taken as their balls of ArmCollision, the finest of them
/// 5 mm smaller, as they may exceed the links by that.
[[nodiscard]] bool touches(const ArmCollision& collision, const Solids& solids, const Configuration& q);
/// Instants of the motions, one every step_s, at which a link touches a solid.
/// O(instants · balls near something · log triangles)
[[nodiscard]] std::size_t count_contacts(const ArmCollision& collision, const Solids& solids,
                                         std::span<const Trajectory> motions, const Executor& executor,
                                         double step_s = 0.03);

}  // namespace saccade
