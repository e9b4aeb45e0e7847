// SPDX-License-Identifier: Apache-2.0
#pragma once
// TriangleMesh and its extraction from the map by marching cubes; LiveMesh: the mesh of a map that keeps changing.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/hidden.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade {

/// Returns the point of triangle abc (corners, edges and interior) nearest to p. A degenerate triangle counts as its
/// longest edge.
[[nodiscard]] Eigen::Vector3d closest_point_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                                        const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Indexed triangle mesh in the world frame, metres; counter-clockwise seen from outside. Normals and colours are per
/// vertex; each list is empty or as long as the vertices.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Rgb8> colors;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct MeshConfig {
  std::uint16_t min_weight{1};  ///< voxels observed less often count as unknown
};

/// Extracts a mesh by marching cubes over the cells between voxel centres whose eight corners are known (thesis §3.1).
/// Vertices are shared, normals are the TSDF gradient. The order is by sector, brick and cell for every thread count.
/// O(dense bricks).
[[nodiscard]] TriangleMesh extract_mesh(const TsdfSnapshot& map, const Executor& executor,
                                        const MeshConfig& config = {});

/// Extracts the same mesh, to the bit, from a map whose sectors may be away: block by block of 4³ sectors, each with
/// its neighbours in memory. The mesh itself is in memory whole. Errors: those of the map's store. O(dense bricks +
/// bytes read); a sector is read 3.4 times on average.
[[nodiscard]] Result<TriangleMesh> extract_mesh_by_parts(const TsdfSnapshot& map, const Executor& executor,
                                                         const MeshConfig& config = {});

/// Returns the smallest box around the vertices; an empty box around the origin where there are none.
[[nodiscard]] Box bounds_of(const TriangleMesh& mesh);

struct MeshSector;

/// Changes made by LiveMesh::update.
struct MeshUpdate {
  std::vector<Index3> bricks;       ///< bricks whose triangles were replaced: all bricks whose triangles may differ
  std::size_t bricks_changed{0};    ///< changed bricks of the map
  std::size_t bricks_extracted{0};  ///< bricks whose cells were visited
  double ms{0.0};
};

/// Mesh that follows a map from snapshot to snapshot. After update(map), mesh() equals extract_mesh(map) to the bit,
/// vertex by vertex; extract_mesh is the first update of a new LiveMesh. Thesis §3.1.
///
/// A brick's triangles read its voxels -1 … 9 along each axis. Triangles of a changed brick and of its up to 26
/// neighbours are extracted anew; all others are kept. Const use from many threads is safe, with one writer at a time.
/// A LiveMesh holds its snapshot, so the map copies what it writes next, as with any other snapshot.
class LiveMesh {
 public:
  explicit LiveMesh(const MeshConfig& config = {});

  /// Brings the mesh to this state of the map, later or earlier, or to another map with the same voxel size (contract).
  /// O(changed_sectors + changed bricks), plus a copy of the sectors that contain any. The thread count never changes
  /// the result.
  MeshUpdate update(const TsdfSnapshot& map, const Executor& executor);

  /// Returns the whole mesh. O(triangles).
  [[nodiscard]] TriangleMesh mesh(const Executor& executor) const;

  /// Returns the triangles of one brick with their own vertices. For viewers, which keep one such mesh per brick and
  /// replace those that update() names. All of them together are the triangles of mesh(), to the bit. The mesh is empty
  /// for a brick without triangles; otherwise it has normals and colours, grey where none was fused. O(triangles of the
  /// brick).
  [[nodiscard]] TriangleMesh mesh_of(const Index3& brick) const;

 private:
  MeshConfig config_;
  TsdfSnapshot map_;
  Hidden<std::vector<MeshSector>> sectors_;  ///< sectors that own anything, in z-y-x order
};

}  // namespace saccade
