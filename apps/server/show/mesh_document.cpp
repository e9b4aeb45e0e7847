// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/scene_yaml.hpp"

#include "saccade/io/clouds/any_mesh.hpp"
#include "server/show/figures.hpp"
#include "server/show/open_document.hpp"
#include "server/show/stand_upright.hpp"

namespace saccade::server {
namespace {

bool all_finite(const TriangleMesh& mesh) {
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    if (!vertex.allFinite()) return false;
  }
  return true;
}

std::string extent_text(const Box& box) {
  const Eigen::Vector3d size = box.max - box.min;
  return decimals(size.x(), 3) + " × " + decimals(size.y(), 3) + " × " + decimals(size.z(), 3) + " m";
}

}  // namespace

Result<SceneDocument> mesh_document(const std::filesystem::path& path, const std::optional<Eigen::Vector3d>& up) {
  SACCADE_TRY(const TriangleMesh mesh, read_any_mesh(path));
  if (!all_finite(mesh)) return Error{Errc::corrupt_data, "has vertices that are not finite", path.string()};
  SceneDocument document;
  document.title = path.filename().string();
  document.kind = DocumentKind::mesh;
  const std::string suffix = path.extension().string();
  UprightHints hints{.up = up};
  const bool is_gltf = suffix == ".glb" || suffix == ".gltf";
  if (is_gltf && !up) hints.up = Eigen::Vector3d::UnitY();  // as glTF's specification says
  SACCADE_CHECK(stand_upright(document, path, mesh.vertices, std::move(hints), false));
  document.bounds = bounds_of_points(mesh.vertices);
  document.facts = {{"vertices", grouped(mesh.vertices.size())},
                    {"triangles", grouped(mesh.triangles.size())},
                    {"size", extent_text(document.bounds)},
                    {"colours", mesh.colors.empty() ? "none" : "per vertex"}};
  document.layers = {triangles_layer("mesh", "Mesh", mesh)};
  return document;
}

}  // namespace saccade::server
