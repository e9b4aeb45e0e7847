// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/ray_scene.hpp"

#include "saccade/core/fnv1a.hpp"

namespace saccade {
namespace {

void add(Fnv1a& hash, const Sphere& sphere) {
  hash.add_all(sphere.center);
  hash.add(sphere.radius_m);
}

void add(Fnv1a& hash, const Box& box) {
  hash.add_all(box.min);
  hash.add_all(box.max);
}

void add(Fnv1a& hash, const Cylinder& cylinder) {
  hash.add_all(cylinder.base);
  hash.add_all(cylinder.top);
  hash.add(cylinder.radius_m);
}

}  // namespace

std::string scene_hash(const RayScene& scene) {
  Fnv1a hash;
  for (const SceneObject& object : scene.scene().objects) hash.add(std::uint64_t{object.fixture ? 1U : 0U});
  for (const ObjectMesh& object : scene.meshes()) {
    hash.add(std::uint64_t{object.support ? 1U : 0U});
    hash.add(std::uint64_t{object.mesh.vertices.size()});
    for (const Eigen::Vector3f& vertex : object.mesh.vertices) hash.add_all(vertex);
    hash.add(std::uint64_t{object.mesh.triangles.size()});
    for (const auto& triangle : object.mesh.triangles) {
      for (const std::uint32_t corner : triangle) hash.add(std::uint64_t{corner});
    }
  }
  add(hash, scene.scene().workspace);
  for (const Region& region : scene.scene().regions) {
    hash.add(std::uint64_t{region.index()});
    std::visit([&hash](const auto& shape) { add(hash, shape); }, region);
  }
  for (const Pose& T_world_camera : scene.scene().scan) hash.add_all(T_world_camera.matrix());
  return hash.text();
}

}  // namespace saccade
