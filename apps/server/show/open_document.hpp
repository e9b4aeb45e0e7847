// SPDX-License-Identifier: Apache-2.0
#pragma once
// open_document: a mesh, map, cloud or run folder as a document of the viewer; and separate functions for each.

#include <Eigen/Core>
#include <filesystem>
#include <optional>

#include "saccade/core/executor.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "server/show/scene_document.hpp"

namespace saccade::server {

/// Opens a file or folder. A folder holds a run; a file is recognised by its suffix, a PLY by whether it has faces. The
/// upward direction comes from `up`, from files beside the document (read_upright_files) or from the points
/// (find_upright).
/// @return not_found for a missing path; unsupported, with the list of supported kinds, for others; errors of the
/// readers.
[[nodiscard]] Result<SceneDocument> open_document(const std::filesystem::path& path, const Executor& executor,
                                                  const std::optional<Eigen::Vector3d>& up = {});

[[nodiscard]] Result<SceneDocument> mesh_document(const std::filesystem::path& path,
                                                  const std::optional<Eigen::Vector3d>& up = {});
/// Shows surface, frontier and segments; O(bricks + surface).
[[nodiscard]] Result<SceneDocument> map_document(const std::filesystem::path& path, const Executor& executor,
                                                 const std::optional<Eigen::Vector3d>& up = {});
/// Shows labels as a separate layer where there is a field label. Very large clouds show every n-th point.
[[nodiscard]] Result<SceneDocument> cloud_document(const std::filesystem::path& path,
                                                   const std::optional<Eigen::Vector3d>& up = {});
/// Shows run.json, or the files of an interrupted exploration, with the files beside it. docs/reference/formats.md.
[[nodiscard]] Result<SceneDocument> run_document(const std::filesystem::path& folder, const Executor& executor,
                                                 const std::optional<Eigen::Vector3d>& up = {});

}  // namespace saccade::server
