// SPDX-License-Identifier: Apache-2.0
#pragma once
// LiveMesh: the mesh of a map that goes on changing, brought up to date where the map changed.

#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/map/mesh_sector.hpp"

namespace saccade {

/// What LiveMesh::update did.
struct MeshUpdate {
  std::vector<Index3> bricks;       ///< whose triangles were replaced: all that may differ and have any, or had
  std::size_t bricks_changed{0};    ///< in the map
  std::size_t bricks_extracted{0};  ///< whose cells were gone through
  double ms{0.0};
};

/// Follows a map from snapshot to snapshot. After update(map), mesh() equals extract_mesh(map) to the bit, vertex by
/// vertex; extract_mesh is the first update of a new one. Thesis §3.1.
///
/// A brick's triangles read the voxels -1 … 9 of the brick along each axis, so those of a changed brick and of the up
/// to 26 around it are extracted anew, all others are kept. Const use from many threads is safe, one writer at a time.
/// It holds the snapshot, which makes the map copy what it writes next, as any other snapshot does.
class LiveMesh {
 public:
  explicit LiveMesh(const MeshConfig& config = {}) : config_{config} {}

  /// Follows the map to this state, any later or earlier one, or that of another map of the same voxel size (contract).
  /// O(changed_sectors + changed bricks), and a copy of the sectors that contain any. The same for every thread count.
  MeshUpdate update(const TsdfSnapshot& map, const Executor& executor);

  /// The whole mesh. O(triangles).
  [[nodiscard]] TriangleMesh mesh(const Executor& executor) const;

  /// The triangles of one brick, with vertices of their own: for viewers, which keep one such mesh per brick and
  /// replace those that update() names. All of them together are the triangles of mesh(), to the bit. Empty where there
  /// are none; otherwise with normals and colours, grey where none was fused. O(triangles of the brick).
  [[nodiscard]] TriangleMesh mesh_of(const Index3& brick) const;

 private:
  MeshConfig config_;
  TsdfSnapshot map_;
  std::vector<MeshSector> sectors_;  ///< that own anything, in z-y-x order
};

}  // namespace saccade
