// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/mesh.hpp"

#include "saccade/map/live_mesh.hpp"

namespace saccade {

TriangleMesh extract_mesh(const TsdfSnapshot& map, const Executor& executor, const MeshConfig& config) {
  LiveMesh live{config};
  live.update(map, executor);
  return live.mesh(executor);
}

}  // namespace saccade
