// SPDX-License-Identifier: Apache-2.0
#pragma once
// turn_outside_out, bodies_of: the closed parts of a mesh file, such as the bodies of an assembly.

#include <cstddef>
#include <vector>

#include "saccade/map/mesh.hpp"

namespace saccade {

// Triangles are of one part where they share a corner: one of the file's vertices, or equal positions, since STL files
// and files with seams share none. A part is closed where its holes have no more than a thousandth of its area. Both
// functions expect finite vertices and valid indices, and take O(n log n), and O(n) more for a part within another.

/// Most closed parts of a mesh that are told apart.
constexpr std::size_t kMostMeshBodies{32};

/// Turns each closed part whose normals point inward. A part that lies within another is turned along with it, since
/// it may be the wall of a cavity. More than kMostMeshBodies closed parts are turned as one. What is open stays: either
/// side may be meant. The order of vertices and triangles stays.
void turn_outside_out(TriangleMesh& mesh);

/// Returns each closed part as a mesh of its own, and all that is open as one more; the whole mesh where there is but
/// one of them, or more than kMostMeshBodies closed ones. Triangles and vertices keep their order; normals are dropped,
/// and so are vertices without triangles where the mesh is divided.
[[nodiscard]] std::vector<TriangleMesh> bodies_of(TriangleMesh mesh);

}  // namespace saccade
