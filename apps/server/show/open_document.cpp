// SPDX-License-Identifier: Apache-2.0
#include "server/show/open_document.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "saccade/scene/scene_yaml.hpp"

namespace saccade::server {
namespace {

namespace fs = std::filesystem;

std::string suffix_of(const fs::path& path) {
  std::string suffix = path.extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return suffix;
}

Result<bool> has_faces(const fs::path& path) {
  SACCADE_TRY(const PlyFile file, read_ply(path));
  const PlyElement* faces = file.find("face");
  return faces != nullptr && faces->table.rows > 0;
}

}  // namespace

Result<SceneDocument> open_document(const fs::path& path, const Executor& executor,
                                    const std::optional<Eigen::Vector3d>& up) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) return Error{Errc::not_found, "there is no such file or folder", path.string()};
  if (fs::is_directory(status)) return run_document(path, executor, up);
  const std::string suffix = suffix_of(path);
  if (suffix == ".sacmap") return map_document(path, executor, up);
  if (suffix == ".ply") {
    SACCADE_TRY(const bool is_mesh, has_faces(path));
    return is_mesh ? mesh_document(path, up) : cloud_document(path, up);
  }
  if (is_mesh_file(path)) return mesh_document(path, up);
  if (is_cloud(path)) return cloud_document(path, up);
  return Error{
      Errc::unsupported,
      std::string{"is nothing to show: name the folder of a run, a map (.sacmap), a mesh (.ply, .obj, .stl, .glb) "
                  "or a cloud ("} +
          std::string{kCloudSuffixes} + ")",
      path.string()};
}

}  // namespace saccade::server
