// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/any_mesh.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>

#include "saccade/io/clouds/ply_io.hpp"

namespace saccade {
namespace {

Eigen::Vector3f to_vector(const aiVector3D& v) { return {v.x, v.y, v.z}; }

/// All parts under a node, moved to where the node stands.
void append(const aiScene& scene, const aiNode& node, const aiMatrix4x4& T_scene_parent, TriangleMesh& mesh) {
  const aiMatrix4x4 T_scene_node = T_scene_parent * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& part = *scene.mMeshes[node.mMeshes[i]];
    const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
    for (unsigned v = 0; v < part.mNumVertices; ++v)
      mesh.vertices.push_back(to_vector(T_scene_node * part.mVertices[v]));
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines
      mesh.triangles.push_back({face.mIndices[0] + offset, face.mIndices[1] + offset, face.mIndices[2] + offset});
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) append(scene, *node.mChildren[i], T_scene_node, mesh);
}

}  // namespace

Result<TriangleMesh> read_any_mesh(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return Error{Errc::not_found, "there is no such mesh", path.string()};
  if (path.extension() == ".ply") return read_mesh(path);  // keeps vertex colours
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path.string(), aiProcess_Triangulate | aiProcess_JoinIdenticalVertices);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    return Error{Errc::corrupt_data, std::string{"no mesh that can be read: "} + importer.GetErrorString(),
                 path.string()};
  }
  TriangleMesh mesh;
  append(*scene, *scene->mRootNode, aiMatrix4x4{}, mesh);
  if (mesh.triangles.empty()) return Error{Errc::corrupt_data, "the file has no triangles", path.string()};
  return mesh;
}

}  // namespace saccade
