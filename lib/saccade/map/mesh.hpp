// SPDX-License-Identifier: Apache-2.0
#pragma once
// TriangleMesh and its extraction from the map by marching cubes.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade {

/// Indexed triangle mesh, world frame, metres; counter-clockwise seen from outside. Normals and colours are per vertex
/// and either empty or as many as vertices.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Rgb8> colors;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct MeshConfig {
  std::uint16_t min_weight{1};  ///< voxels observed less often count as unknown
};

/// Marching cubes over the cells between voxel centres whose eight corners are known (thesis §3.1). Vertices are
/// shared, normals are the TSDF gradient. Order by sector, brick and cell: the same for every thread count.
/// O(dense bricks).
[[nodiscard]] TriangleMesh extract_mesh(const TsdfSnapshot& map, const Executor& executor,
                                        const MeshConfig& config = {});

/// Smallest box around its vertices; an empty box around the origin when there are none.
[[nodiscard]] Box bounds_of(const TriangleMesh& mesh);

}  // namespace saccade
