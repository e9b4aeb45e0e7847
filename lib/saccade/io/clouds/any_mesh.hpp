// SPDX-License-Identifier: Apache-2.0
#pragma once
// read_any_mesh, stated_up_axis: triangles from a file of any common format.

#include <filesystem>
#include <optional>

#include "saccade/core/result.hpp"
#include "saccade/map/mesh.hpp"

namespace saccade {

/// Reads triangles from PLY, OBJ (both with vertex colours), STL, OFF, GLB and other formats of assimp, all parts in
/// one mesh. Coordinates are those of the file, in metres where the file states its unit (COLLADA, FBX), and along the
/// file's own axes. What assimp reads is read in a child process, which may take 10 s and 256 MiB, and more for large
/// files.
/// @return not_found; corrupt_data with the place or assimp's reason, or where its reader crashed or took too much.
[[nodiscard]] Result<TriangleMesh> read_any_mesh(const std::filesystem::path& path);

/// Returns the axis that points up in the file, 'x', 'y' or 'z': what a COLLADA file states, 'y' for glTF; nullopt
/// where the format says nothing. Reads the file's beginning.
[[nodiscard]] std::optional<char> stated_up_axis(const std::filesystem::path& path);

}  // namespace saccade
