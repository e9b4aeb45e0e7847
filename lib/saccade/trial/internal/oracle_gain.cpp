// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/internal/oracle_gain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "saccade/map/mesh.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

/// A point of a true surface, and where it faces.
struct Missing {
  Vector3d p_world;
  Vector3d normal_world;
};

/// What the map's mesh does not have, of every so many points that can be observed.
std::vector<Missing> missing_of(const Truth& truth, const TsdfSnapshot& map, const Executor& executor) {
  const std::vector<Eigen::Vector3f>& points = truth.observable_points();
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kOraclePoints);
  const TriangleMesh mesh = extract_mesh(map, executor);
  std::optional<MeshDistance> known;
  if (!mesh.triangles.empty()) known = MeshDistance::build(mesh).value();
  const double voxel_m = map.config.voxel_size_m;
  std::vector<Missing> missing;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const Vector3d p = points[i].cast<double>();
    if (known && known->distance_m(p, 2.0 * voxel_m) <= voxel_m) continue;
    missing.push_back({p, truth.observable_normals()[i].cast<double>()});
  }
  return missing;
}

/// Those that can be seen from the camera's centre, however it is turned.
std::vector<Vector3d> visible_from(const Vector3d& center, const std::vector<Missing>& missing, const RayScene& scene) {
  constexpr double kLeastCosine{0.17364817766693041};  // of 80°
  constexpr double kTolerance{1e-5};                   // of the distance: the point's own triangle is no obstacle
  std::vector<Vector3d> visible;
  for (const Missing& point : missing) {
    const Vector3d ray = point.p_world - center;
    if (-point.normal_world.dot(ray) < kLeastCosine * ray.norm()) continue;
    const auto hit = scene.cast(center, ray);
    if (hit && hit->t > 1.0 - kTolerance) visible.push_back(point.p_world);
  }
  return visible;
}

std::size_t in_picture(const std::vector<Vector3d>& visible, const Pose& T_world_camera, const PinholeCamera& camera) {
  const Pose T_camera_world = T_world_camera.inverse(Eigen::Isometry);
  return static_cast<std::size_t>(std::count_if(visible.begin(), visible.end(), [&](const Vector3d& p_world) {
    const Vector3d p = T_camera_world * p_world;
    if (p.z() < camera.min_range_m || p.z() > camera.max_range_m) return false;
    const double u = camera.fx * p.x() / p.z() + camera.cx;
    const double v = camera.fy * p.y() / p.z() + camera.cy;
    return u >= -0.5 && u < camera.width - 0.5 && v >= -0.5 && v < camera.height - 0.5;
  }));
}

}  // namespace

OracleGain::OracleGain(Truth truth, const PinholeCamera& camera, double tilt_rad)
    : truth_{std::move(truth)}, camera_{widened_vertically(camera, tilt_rad)} {}

Result<std::vector<double>> OracleGain::evaluate(const PlanningContext& context, const RegionOfInterest& /*region*/,
                                                 std::span<const Pose> T_world_camera) {
  const std::vector<Missing> missing = missing_of(truth_, context.map, context.executor);
  const std::vector<std::size_t> starts = starts_of_centers(T_world_camera);
  std::vector<double> gains(T_world_camera.size());
  context.executor.parallel_for(starts.size() - 1, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const Vector3d center = T_world_camera[starts[s]].translation();
      const std::vector<Vector3d> visible = visible_from(center, missing, truth_.scene());
      for (std::size_t i = starts[s]; i < starts[s + 1]; ++i) {
        gains[i] = static_cast<double>(in_picture(visible, T_world_camera[i], camera_));
      }
    }
  });
  return gains;
}

Result<RankedViews> OracleGain::best(const PlanningContext& context, const RegionOfInterest& region,
                                     std::span<const Pose> T_world_camera, std::size_t count) {
  SACCADE_TRY(RankedViews ranked, Gain::best(context, region, T_world_camera, count));
  std::erase_if(ranked.views, [](const RankedView& view) { return !(view.gain > 0.0); });
  ranked.by_gain = false;
  return ranked;
}

NamedPlanner oracle_planner() {
  const auto make = [](const PlannerSetup& setup) {
    SACCADE_EXPECTS(setup.truth != nullptr);
    return PlannerParts{std::make_shared<WholeWorkspace>(),
                        std::make_shared<ContourViews>(setup.contour_views, setup.contours),
                        std::make_shared<OracleGain>(*setup.truth, setup.camera, setup.gain.tilt_rad), setup.planner};
  };
  return {"oracle", "what one would choose who knew the scene", 200.0, false, true, make, "points"};
}

}  // namespace saccade
