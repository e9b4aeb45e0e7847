// SPDX-License-Identifier: Apache-2.0
#pragma once
// Truth and Metrics: how complete and how right a map is of a scene whose surfaces are known. Definitions:
// docs/metrics.md.

#include <optional>

#include "saccade/core/executor.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/scene/mesh_distance.hpp"
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

}  // namespace saccade
