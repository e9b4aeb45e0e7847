// SPDX-License-Identifier: Apache-2.0
#pragma once
// TriangleMesh and its extraction from the map by marching cubes; LiveMesh: the mesh of a map that goes on changing.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/hidden.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade {

/// The point of triangle abc (corners, edges and inside) nearest to p. A degenerate triangle is its longest edge.
[[nodiscard]] Eigen::Vector3d closest_point_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                                        const Eigen::Vector3d& b, const Eigen::Vector3d& c);

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

struct MeshSector;

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
  explicit LiveMesh(const MeshConfig& config = {});

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
  Hidden<std::vector<MeshSector>> sectors_;  ///< that own anything, in z-y-x order
};

}  // namespace saccade
