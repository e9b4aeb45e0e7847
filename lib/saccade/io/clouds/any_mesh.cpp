// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/any_mesh.hpp"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "saccade/io/clouds/internal/cloud_kind.hpp"
#include "saccade/io/clouds/internal/guarded_reading.hpp"
#include "saccade/io/clouds/internal/mesh_text.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade {
namespace {

Eigen::Vector3f to_vector(const aiVector3D& v) { return {v.x, v.y, v.z}; }

/// Appends all parts under a node, transformed by the node's pose. A pose that mirrors turns outside in; the corners'
/// order turns it out again.
void append(const aiScene& scene, const aiNode& node, const aiMatrix4x4& T_scene_parent, TriangleMesh& mesh) {
  const aiMatrix4x4 T_scene_node = T_scene_parent * node.mTransformation;
  const bool is_mirrored = aiMatrix3x3{T_scene_node}.Determinant() < 0.0F;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& part = *scene.mMeshes[node.mMeshes[i]];
    const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
    for (unsigned v = 0; v < part.mNumVertices; ++v)
      mesh.vertices.push_back(to_vector(T_scene_node * part.mVertices[v]));
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines
      mesh.triangles.push_back({face.mIndices[0] + offset, face.mIndices[1] + offset, face.mIndices[2] + offset});
      if (is_mirrored) std::swap(mesh.triangles.back()[1], mesh.triangles.back()[2]);
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) append(scene, *node.mChildren[i], T_scene_node, mesh);
}

/// Reads coordinates as the file has them, scaled by the unit that it states.
Result<TriangleMesh> read_by_assimp(const std::filesystem::path& path) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);  // assimp would turn Z_UP to y
  const aiScene* scene =
      importer.ReadFile(path.string(), aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_GlobalScale);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    return Error{Errc::corrupt_data, std::string{"no mesh that can be read: "} + importer.GetErrorString(),
                 path.string()};
  }
  TriangleMesh mesh;
  append(*scene, *scene->mRootNode, aiMatrix4x4{}, mesh);
  if (mesh.triangles.empty()) return Error{Errc::corrupt_data, "the file has no triangles", path.string()};
  return mesh;
}

/// Removes vertices that no triangle has: those of points and lines would widen the mesh's bounds.
TriangleMesh without_loose_vertices(TriangleMesh mesh) {
  constexpr std::uint32_t kLoose{std::numeric_limits<std::uint32_t>::max()};
  std::vector<std::uint32_t> places(mesh.vertices.size(), kLoose);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) places[corner] = 0;
  }
  std::uint32_t kept{0};
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] == kLoose) continue;
    mesh.vertices[kept] = mesh.vertices[i];
    if (!mesh.colors.empty()) mesh.colors[kept] = mesh.colors[i];
    places[i] = kept++;
  }
  mesh.vertices.resize(kept);
  if (!mesh.colors.empty()) mesh.colors.resize(kept);
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) corner = places[corner];
  }
  return mesh;
}

Result<TriangleMesh> read_by(Result<TriangleMesh> (*parse)(std::string_view), const std::filesystem::path& path) {
  SACCADE_TRY(const std::string file, read_text_file(path));
  SACCADE_TRY(TriangleMesh mesh, in_file(parse(file), path));
  return without_loose_vertices(std::move(mesh));
}

/// Compares the lengths that a GLB states with the file's.
Status check_glb(const std::filesystem::path& path) {
  constexpr std::size_t kHeadWords{4};  // magic, version, bytes of the file, bytes of the first chunk
  std::array<std::uint32_t, kHeadWords> head{};
  std::ifstream file{path, std::ios::binary};
  file.read(reinterpret_cast<char*>(head.data()), sizeof(head));
  constexpr std::uint32_t kMagic{0x46546C67};             // "glTF"
  if (file.gcount() > 0 && head[0] != kMagic) return {};  // another format, whose reader says so
  std::error_code code;
  const std::uintmax_t size = std::filesystem::file_size(path, code);
  constexpr std::uintmax_t kBeforeChunk{20};
  if (code || size < kBeforeChunk) {
    return Error{Errc::corrupt_data,
                 "the file ends within the header of a GLB, after " + std::to_string(size) + " bytes", path.string()};
  }
  const std::uintmax_t stated = std::max<std::uintmax_t>(head[2], kBeforeChunk + head[3]);
  if (stated <= size) return {};
  return Error{
      Errc::corrupt_data,
      "a GLB that states " + std::to_string(stated) + " bytes, but the file ends after " + std::to_string(size),
      path.string()};
}

}  // namespace

Result<TriangleMesh> read_any_mesh(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return Error{Errc::not_found, "there is no such mesh", path.string()};
  const std::string suffix = lower_suffix(path);
  if (suffix == ".ply") return read_mesh(path);
  if (suffix == ".stl") return read_by(parse_stl, path);
  if (suffix == ".obj") return read_by(parse_obj, path);
  if (suffix == ".off") return read_by(parse_off, path);
  if (suffix == ".glb") SACCADE_CHECK(check_glb(path));
  return read_guarded(path, limits_for(path), [&] { return read_by_assimp(path); });
}

std::optional<char> stated_up_axis(const std::filesystem::path& path) {
  const std::string suffix = lower_suffix(path);
  if (suffix == ".glb" || suffix == ".gltf") return 'y';
  if (suffix != ".dae") return std::nullopt;
  constexpr std::size_t kHeadBytes{1 << 16};  // the asset stands first
  std::string head(kHeadBytes, '\0');
  std::ifstream file{path, std::ios::binary};
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  constexpr std::string_view kTag{"<up_axis>"};
  const std::size_t at = head.find(kTag);
  if (at == std::string::npos) return 'y';  // the default of COLLADA
  const std::string_view stated = std::string_view{head}.substr(at + kTag.size());
  return stated.starts_with("Z_UP") ? 'z' : stated.starts_with("X_UP") ? 'x' : 'y';
}

}  // namespace saccade
