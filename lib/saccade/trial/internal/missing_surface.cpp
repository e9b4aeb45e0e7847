// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/internal/missing_surface.hpp"

#include <algorithm>
#include <optional>

#include "saccade/map/mesh.hpp"

namespace saccade {

using Eigen::Vector3d;

std::vector<MissingPoint> missing_of(const GroundTruth& truth, const TsdfSnapshot& map, const Executor& executor) {
  const std::vector<Eigen::Vector3f>& points = truth.observable_points();
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kOraclePoints);
  const TriangleMesh mesh = extract_mesh(map, executor);
  std::optional<MeshDistance> known;
  if (!mesh.triangles.empty()) known = MeshDistance::build(mesh).value();
  const double voxel_m = map.config.voxel_size_m;
  std::vector<MissingPoint> missing;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const Vector3d p = points[i].cast<double>();
    if (known && known->distance_m(p, 2.0 * voxel_m) <= voxel_m) continue;
    missing.push_back({p, truth.observable_normals()[i].cast<double>()});
  }
  return missing;
}

std::vector<std::size_t> visible_from(const Vector3d& center, std::span<const MissingPoint> missing,
                                      const RayScene& scene) {
  constexpr double kLeastCosine{0.17364817766693041};  // cosine of 80°
  constexpr double kTolerance{1e-5};                   // share of the distance: the point's own triangle is no obstacle
  std::vector<std::size_t> visible;
  for (std::size_t i = 0; i < missing.size(); ++i) {
    const Vector3d ray = missing[i].p_world - center;
    if (-missing[i].normal_world.dot(ray) < kLeastCosine * ray.norm()) continue;
    const auto hit = scene.cast(center, ray);
    if (hit && hit->t > 1.0 - kTolerance) visible.push_back(i);
  }
  return visible;
}

bool is_in_picture(const Vector3d& p_world, const Pose& T_camera_world, const PinholeCamera& camera) {
  const Vector3d p = T_camera_world * p_world;
  if (p.z() < camera.min_range_m || p.z() > camera.max_range_m) return false;
  const double u = camera.fx * p.x() / p.z() + camera.cx;
  const double v = camera.fy * p.y() / p.z() + camera.cy;
  return u >= -0.5 && u < camera.width - 0.5 && v >= -0.5 && v < camera.height - 0.5;
}

}  // namespace saccade
