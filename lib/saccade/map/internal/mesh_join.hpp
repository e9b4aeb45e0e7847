// SPDX-License-Identifier: Apache-2.0
#pragma once
// join_mesh, mesh_of_brick: indexed meshes out of the surfaces of sectors. Used by LiveMesh.

#include <span>

#include "saccade/core/executor.hpp"
#include "saccade/map/internal/mesh_sector.hpp"

namespace saccade {

/// One mesh with shared vertices, by sector, brick and cell. The sectors are in z-y-x order. Vertices without a
/// gradient get the mean normal of their triangles, weighted by area.
[[nodiscard]] TriangleMesh join_mesh(std::span<const MeshSector> sectors, const Executor& executor);

/// The triangles of one brick's cells with vertices of their own, each as in join_mesh; always with colours.
[[nodiscard]] TriangleMesh mesh_of_brick(std::span<const MeshSector> sectors, const Index3& brick);

}  // namespace saccade
