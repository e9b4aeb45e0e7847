// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/scene.hpp"

#include <algorithm>

namespace saccade {
namespace {

Box around(const TriangleMesh& mesh) {
  constexpr double kLeast_m{1e-3};
  Box box{mesh.vertices.front().cast<double>(), mesh.vertices.front().cast<double>()};
  for (const Eigen::Vector3f& p : mesh.vertices) {
    box.min = box.min.cwiseMin(p.cast<double>());
    box.max = box.max.cwiseMax(p.cast<double>());
  }
  // Vertices are floats; rounding to micrometres restores the numbers of the scene.
  const auto rounded = [](const Eigen::Vector3d& p) { return Eigen::Vector3d{(p.array() * 1e6).round() / 1e6}; };
  box = {rounded(box.min), rounded(box.max)};
  const Eigen::Vector3d lacking = (kLeast_m - (box.max - box.min).array()).max(0.0).matrix();
  return {box.min - 0.5 * lacking, box.max + 0.5 * lacking};
}

}  // namespace

Result<std::vector<FixtureBox>> fixture_boxes(const Scene& scene) {
  Scene fixed = scene;
  std::erase_if(fixed.objects, [](const SceneObject& object) { return !object.fixture && !object.support; });
  if (fixed.objects.empty()) return std::vector<FixtureBox>{};
  SACCADE_TRY(const std::vector<ObjectMesh> meshes, true_meshes(fixed));
  std::vector<FixtureBox> boxes;
  for (const ObjectMesh& object : meshes) {
    if (!object.mesh.vertices.empty()) boxes.push_back({object.name, around(object.mesh), object.support});
  }
  return boxes;
}

}  // namespace saccade
