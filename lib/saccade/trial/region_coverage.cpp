// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/metrics.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/scene/surface_samples.hpp"

namespace saccade {
namespace {

/// Counts the points within that distance of the mesh.
std::size_t covered(const std::vector<Eigen::Vector3f>& points, const MeshDistance& mesh, double within_m,
                    const Executor& executor) {
  const std::vector<double> distances_m = mesh.distances_m(points, 2.0 * within_m, executor);
  return static_cast<std::size_t>(
      std::count_if(distances_m.begin(), distances_m.end(), [&](double distance) { return distance <= within_m; }));
}

}  // namespace

Result<RegionSurface> observable_in(const RayScene& scene, const Region& region, double spacing_m,
                                    const Executor& executor) {
  if (!(std::isfinite(spacing_m) && spacing_m > 0.0)) {
    return Error{Errc::invalid_argument, "the spacing of the samples must be positive", "region coverage"};
  }
  SACCADE_CHECK(validate(region));
  const SurfaceSamples all = sample_surfaces(scene.meshes(), spacing_m, scene.scene().workspace);
  SurfaceSamples inside;
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    if (!contains(region, all.points[i].cast<double>())) continue;
    inside.points.push_back(all.points[i]);
    inside.normals.push_back(all.normals[i]);
    inside.objects.push_back(all.objects[i]);
  }
  const std::vector<std::uint8_t> seen = observable(scene, inside, {}, executor);
  RegionSurface surface;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i] == 0) continue;
    const bool support = scene.meshes()[inside.objects[i]].support;
    (support ? surface.of_supports : surface.of_objects).push_back(inside.points[i]);
  }
  return surface;
}

RegionCoverage measure_coverage(const RegionSurface& truth, const TriangleMesh& mesh, double within_m,
                                const Executor& executor) {
  if (mesh.triangles.empty()) return measure_coverage(truth, nullptr, within_m, executor);
  const auto distance = MeshDistance::build(mesh);
  SACCADE_EXPECTS(distance.ok());
  return measure_coverage(truth, &*distance, within_m, executor);
}

RegionCoverage measure_coverage(const RegionSurface& truth, const MeshDistance* mesh, double within_m,
                                const Executor& executor) {
  SACCADE_EXPECTS(within_m > 0.0);
  const auto count = [&](const std::vector<Eigen::Vector3f>& points) {
    return mesh != nullptr ? covered(points, *mesh, within_m, executor) : std::size_t{0};
  };
  const auto share = [](std::size_t part, std::size_t of) -> std::optional<double> {
    if (of == 0) return std::nullopt;
    return static_cast<double>(part) / static_cast<double>(of);
  };
  const std::size_t objects = count(truth.of_objects);
  const std::size_t supports = count(truth.of_supports);
  return {share(objects, truth.of_objects.size()),
          share(objects + supports, truth.of_objects.size() + truth.of_supports.size())};
}

}  // namespace saccade
