// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/solids.hpp"

#include <algorithm>
#include <utility>

namespace saccade {

TriangleMesh joined_mesh(const std::vector<ObjectMesh>& meshes, const std::function<bool(std::size_t)>& wanted) {
  TriangleMesh all;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (!wanted(i)) continue;
    const TriangleMesh& mesh = meshes[i].mesh;
    const auto offset = static_cast<std::uint32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const auto& [a, b, c] : mesh.triangles) all.triangles.push_back({a + offset, b + offset, c + offset});
  }
  return all;
}

Result<Solids> Solids::build(const RayScene& scene, const std::function<bool(const SceneObject&)>& wanted) {
  std::vector<RayScene> bodies;
  for (const SceneObject& object : scene.scene().objects) {
    if (!wanted(object)) continue;
    Scene alone = scene.scene();
    alone.objects = {object};
    SACCADE_TRY(RayScene body, RayScene::build(std::move(alone)));
    bodies.push_back(std::move(body));
  }
  std::optional<MeshDistance> surface;
  if (!bodies.empty()) {
    const auto of_object = [&](std::size_t i) { return wanted(scene.scene().objects[i]); };
    SACCADE_TRY(surface, MeshDistance::build(joined_mesh(scene.meshes(), of_object)));
  }
  return Solids{std::move(bodies), std::move(surface)};
}

bool Solids::contain(const Eigen::Vector3d& p) const {
  // A ray upwards from p inside a closed body leaves the body more often than it enters it. Where two closed parts of
  // one body overlap, such as a handle and its wall, the difference exceeds one.
  constexpr double kStep_m{1e-6};
  const auto inside = [&p](const RayScene& body) {
    int left = 0;
    Eigen::Vector3d from = p;
    for (auto hit = body.cast(from, Eigen::Vector3d::UnitZ()); hit; hit = body.cast(from, Eigen::Vector3d::UnitZ())) {
      from.z() += hit->t + kStep_m;
      left += hit->normal_world.z() > 0.0 ? 1 : hit->normal_world.z() < 0.0 ? -1 : 0;
    }
    return left > 0;
  };
  return std::any_of(bodies_.begin(), bodies_.end(), inside);
}

double Solids::distance_m(const Eigen::Vector3d& p, double beyond_m) const {
  return surface_ ? surface_->distance_m(p, beyond_m) : beyond_m;
}

}  // namespace saccade
