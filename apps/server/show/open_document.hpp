// SPDX-License-Identifier: Apache-2.0
#pragma once
// open_document: a mesh, map, cloud or folder of a run as a document to be shown; and those one by one.

#include <filesystem>
#include <optional>

#include "saccade/core/executor.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "server/show/scene_document.hpp"

namespace saccade::server {

/// A folder is that of a run; a file is told by its suffix, a PLY by whether it has faces.
/// @return not_found for what is not there; unsupported, with what there is to show, for what is none of these; errors
///         of the readers.
[[nodiscard]] Result<SceneDocument> open_document(const std::filesystem::path& path, const Executor& executor);

[[nodiscard]] Result<SceneDocument> mesh_document(const std::filesystem::path& path);
/// Surface, frontier and segments; O(bricks + surface).
[[nodiscard]] Result<SceneDocument> map_document(const std::filesystem::path& path, const Executor& executor);
/// With labels as a layer of their own where there is a field label. Of very large clouds every n-th point.
[[nodiscard]] Result<SceneDocument> cloud_document(const std::filesystem::path& path);
/// run.json, or what an interrupted exploration left, with what lies beside it. docs/formats.md.
[[nodiscard]] Result<SceneDocument> run_document(const std::filesystem::path& folder, const Executor& executor);

}  // namespace saccade::server
