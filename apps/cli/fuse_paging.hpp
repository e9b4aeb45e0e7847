// SPDX-License-Identifier: Apache-2.0
#pragma once
// Paging of the map of a fusion run: --map-memory, --moving-volume.

#include <nlohmann/json.hpp>
#include <string>

#include "fuse_options.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/report/viewpoint.hpp"

namespace saccade::cli {

/// Pages the map as the options say; nothing where they do not. What goes out lies in --page-folder, or in `out`.
[[nodiscard]] Status page_map(TsdfMap& map, const FuseOptions& options, const std::filesystem::path& out);

/// null for a map that is not paged.
[[nodiscard]] nlohmann::json paging_json(const std::optional<PagingStats>& stats, const FuseOptions& options);
/// A line for the summary.
[[nodiscard]] std::string paging_text(const PagingStats& stats);

/// The mesh of a map, whether it is paged or not.
[[nodiscard]] Result<TriangleMesh> mesh_of(const TsdfSnapshot& map, const Executor& executor);

/// A part of a map for a picture, and the box that the picture is to keep to.
struct PictureMap {
  TsdfSnapshot map;
  std::optional<Box> crop;
};
/// The map itself, or what a paged one holds within the camera's range.
[[nodiscard]] Result<PictureMap> map_for_picture(const TsdfSnapshot& map, const Viewpoint& view,
                                                 const Executor& executor);

}  // namespace saccade::cli
