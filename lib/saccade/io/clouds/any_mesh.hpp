// SPDX-License-Identifier: Apache-2.0
#pragma once
// read_any_mesh: triangles from a file of any common format.

#include <filesystem>

#include "saccade/core/result.hpp"
#include "saccade/map/mesh.hpp"

namespace saccade {

/// Triangles of PLY (with vertex colours), STL, OBJ, GLB and what else assimp reads, all parts in one mesh. not_found;
/// corrupt_data with assimp's reason.
[[nodiscard]] Result<TriangleMesh> read_any_mesh(const std::filesystem::path& path);

}  // namespace saccade
