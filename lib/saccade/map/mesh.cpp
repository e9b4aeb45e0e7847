// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/mesh.hpp"

namespace saccade {

TriangleMesh extract_mesh(const TsdfSnapshot& map, const Executor& executor, const MeshConfig& config) {
  LiveMesh live{config};
  live.update(map, executor);
  return live.mesh(executor);
}

Box bounds_of(const TriangleMesh& mesh) {
  Box box;
  if (mesh.vertices.empty()) return box;
  Eigen::Vector3f lo = mesh.vertices.front();
  Eigen::Vector3f hi = lo;
  for (const Eigen::Vector3f& p : mesh.vertices) {
    lo = lo.cwiseMin(p);
    hi = hi.cwiseMax(p);
  }
  return {lo.cast<double>(), hi.cast<double>()};
}

}  // namespace saccade
