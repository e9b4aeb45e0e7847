// SPDX-License-Identifier: Apache-2.0
#pragma once
// join_mesh, mesh_of_brick: indexed meshes from the surfaces of sectors. Used by LiveMesh.

#include <span>

#include "saccade/core/executor.hpp"
#include "saccade/map/internal/mesh_sector.hpp"

namespace saccade {

/// Joins the sectors, given in z-y-x order, to one mesh with shared vertices, ordered by sector, brick and cell.
/// Vertices without a gradient get the area-weighted mean normal of their triangles.
[[nodiscard]] TriangleMesh join_mesh(std::span<const MeshSector> sectors, const Executor& executor);

/// Returns the triangles of one brick's cells with their own vertices, as in join_mesh; always with colours.
[[nodiscard]] TriangleMesh mesh_of_brick(std::span<const MeshSector> sectors, const Index3& brick);

}  // namespace saccade
