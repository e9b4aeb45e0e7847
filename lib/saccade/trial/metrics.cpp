// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/metrics.hpp"

#include "saccade/core/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

using Eigen::Vector3d;

/// Returns the points of the mesh inside the workspace that do not lie on a support.
std::vector<Eigen::Vector3f> points_off_supports(const GroundTruth& truth, const TriangleMesh& mesh, double within_m,
                                                 const Executor& executor) {
  const Box& workspace = truth.scene().scene().workspace;
  const std::vector<Eigen::Vector3f> all =
      sample_surfaces({{"mesh", mesh, false}}, truth.spacing_m(), workspace).points;
  const std::vector<double> to_supports_m = truth.to_supports_m(all, 2.0 * within_m, executor);
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (to_supports_m[i] > within_m) points.push_back(all[i]);
  }
  return points;
}

}  // namespace

Result<GroundTruth> GroundTruth::build(const RayScene& scene, double spacing_m, const Executor& executor) {
  if (!(std::isfinite(spacing_m) && spacing_m > 0.0)) {
    return Error{Errc::invalid_argument, "the spacing of the samples must be positive", "truth"};
  }
  const auto is_support = [&scene](std::size_t i) { return scene.meshes()[i].support; };
  const TriangleMesh objects = joined_mesh(scene.meshes(), [&](std::size_t i) { return !is_support(i); });
  const TriangleMesh supports = joined_mesh(scene.meshes(), is_support);
  if (objects.triangles.empty()) return Error{Errc::invalid_argument, "there is nothing but supports", "truth"};
  SACCADE_TRY(MeshDistance object_distance, MeshDistance::build(objects));
  SACCADE_TRY(Solids bodies, Solids::build(scene, [](const SceneObject&) { return true; }));
  Data data{scene, std::move(bodies), spacing_m, {}, {}, std::move(object_distance), std::nullopt, nothing_kept()};
  if (!supports.triangles.empty()) {
    SACCADE_TRY(data.supports, MeshDistance::build(supports));
  }
  std::vector<ObjectMesh> wanted;
  for (const ObjectMesh& object : scene.meshes()) {
    if (!object.support) wanted.push_back(object);
  }
  const SurfaceSamples samples = sample_surfaces(wanted, spacing_m, scene.scene().workspace);
  const std::vector<std::uint8_t> seen = observable(scene, samples, {}, executor);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i] == 0) continue;
    data.observable_points.push_back(samples.points[i]);
    data.observable_normals.push_back(samples.normals[i]);
  }
  if (data.observable_points.empty()) {
    return Error{Errc::invalid_argument,
                 "no surface of an object can be seen in the workspace; move the workspace or the objects", "truth"};
  }
  return GroundTruth{std::make_shared<const Data>(std::move(data))};
}

double GroundTruth::to_objects_m(const Vector3d& p, double beyond_m) const {
  return data_->objects.distance_m(p, beyond_m);
}

double GroundTruth::to_supports_m(const Vector3d& p, double beyond_m) const {
  return data_->supports ? data_->supports->distance_m(p, beyond_m) : beyond_m;
}

std::vector<double> GroundTruth::to_objects_m(std::span<const Eigen::Vector3f> points, double beyond_m,
                                              const Executor& executor) const {
  return data_->objects.distances_m(points, beyond_m, executor);
}

std::vector<double> GroundTruth::to_supports_m(std::span<const Eigen::Vector3f> points, double beyond_m,
                                               const Executor& executor) const {
  if (!data_->supports) return std::vector<double>(points.size(), beyond_m);
  return data_->supports->distances_m(points, beyond_m, executor);
}

bool GroundTruth::inside_solid(const Vector3d& p) const { return data_->bodies.contain(p); }

bool looks_at_object(const GroundTruth& truth, const Pose& T_world_camera) {
  constexpr double kStep_m{0.01};
  const Box& workspace = truth.scene().scene().workspace;
  const Vector3d origin = T_world_camera.translation();
  const Vector3d axis = T_world_camera.linear().col(2);
  const auto hit = truth.scene().cast(origin, axis);
  const double past_m =
      (0.5 * (workspace.min + workspace.max) - origin).norm() + (workspace.max - workspace.min).norm();
  const double end_m = hit ? std::min(hit->t, past_m) : past_m;
  const auto is_near = [&](double t_m) {
    return truth.to_objects_m(origin + t_m * axis, 2.0 * kAtObject_m) <= kAtObject_m;
  };
  for (double t_m = 0.0; t_m < end_m; t_m += kStep_m) {
    if (is_near(t_m)) return true;
  }
  return is_near(end_m);
}

Metrics measure(const GroundTruth& truth, const TsdfSnapshot& map, const TriangleMesh& mesh, const Executor& executor) {
  Metrics metrics = measure_mesh(truth, mesh, map.config.voxel_size_m, executor);
  metrics.unknown_near_objects = unknown_near_objects(truth, map, executor);
  return metrics;
}

Metrics measure_mesh(const GroundTruth& truth, const TriangleMesh& mesh, double within_m, const Executor& executor) {
  Metrics metrics;
  if (mesh.triangles.empty()) return metrics;
  const auto built = MeshDistance::build(mesh);
  SACCADE_EXPECTS(built.ok());
  const MeshDistance& reconstruction = *built;
  const Box& workspace = truth.scene().scene().workspace;
  const double farthest_m = (workspace.max - workspace.min).norm();

  const std::vector<Eigen::Vector3f>& wanted = truth.observable_points();
  const auto share = [](double count, std::size_t of) { return count / static_cast<double>(of); };
  const std::vector<double> missing_m = reconstruction.distances_m(wanted, farthest_m, executor);
  const auto within = [](const std::vector<double>& distances, double limit) {
    return static_cast<double>(std::count_if(distances.begin(), distances.end(), [&](double d) { return d <= limit; }));
  };
  metrics.coverage = share(within(missing_m, within_m), wanted.size());

  const std::vector<Eigen::Vector3f> found = points_off_supports(truth, mesh, within_m, executor);
  if (found.empty()) return metrics;
  std::vector<double> wrong_m = truth.to_objects_m(found, farthest_m, executor);
  const std::vector<double> to_supports_m = truth.to_supports_m(found, farthest_m, executor);
  for (std::size_t i = 0; i < found.size(); ++i) wrong_m[i] = std::min(wrong_m[i], to_supports_m[i]);
  metrics.accuracy_m = mean(wrong_m);
  metrics.chamfer_m = 0.5 * (mean(wrong_m) + mean(missing_m));
  const double precision = share(within(wrong_m, kFScoreDistance_m), wrong_m.size());
  const double recall = share(within(missing_m, kFScoreDistance_m), missing_m.size());
  metrics.f_score = precision + recall > 0.0 ? 2.0 * precision * recall / (precision + recall) : 0.0;
  return metrics;
}

}  // namespace saccade
