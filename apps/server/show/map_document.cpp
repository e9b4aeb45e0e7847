// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/maps/sacmap.hpp"
#include "server/show/map_layers.hpp"
#include "server/show/open_document.hpp"
#include "server/show/stand_upright.hpp"

namespace saccade::server {

Result<SceneDocument> map_document(const std::filesystem::path& path, const Executor& executor,
                                   const std::optional<Eigen::Vector3d>& up) {
  SACCADE_TRY(const TsdfSnapshot map, load_map(path, executor));
  const TriangleMesh mesh = extract_mesh(map, executor);
  SceneDocument document;
  document.title = path.filename().string();
  document.kind = DocumentKind::map;
  document.bounds = bounds_of_map(map, mesh);
  SACCADE_CHECK(stand_upright(document, path, mesh.vertices, {.up = up}, false));
  document.facts = facts_of_map(map, mesh);
  SACCADE_TRY(document.layers, layers_of_map(map, mesh, executor));
  return document;
}

}  // namespace saccade::server
