// SPDX-License-Identifier: Apache-2.0
#pragma once
// Scenes from YAML files, the scenes that come with Saccade, and scenes with a user's mesh file on a table. The format:
// docs/guides/scenes.md.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/names.hpp"
#include "saccade/scene/scene.hpp"

namespace saccade {

/// Reads a scene. Mesh paths are relative to `folder`. Answers corrupt_data for invalid YAML, an unknown or missing
/// key, or a value of the wrong kind, with line and column; and the errors of read_any_mesh and Scene::validate.
[[nodiscard]] Result<Scene> parse_scene(std::string_view yaml, const std::filesystem::path& folder = {});
/// Reads a scene from a file.
[[nodiscard]] Result<Scene> read_scene(const std::filesystem::path& path);

struct BuiltinScene {
  std::string_view name;
  std::string_view yaml;
};
/// Returns the files of scenes/, in alphabetical order.
[[nodiscard]] const std::vector<BuiltinScene>& builtin_scenes();

enum class UpAxis : std::uint8_t { y, z };
inline constexpr auto kUpAxisNames = make_names<UpAxis>({{UpAxis::y, "y"}, {UpAxis::z, "z"}});

struct MeshSceneConfig {
  double scale{1.0};           ///< metres per unit of the file
  std::optional<UpAxis> up{};  ///< default: stated_up_axis, or z

  [[nodiscard]] Status validate() const;
};

/// Finds a built-in scene by its name, "clutter:SEED", "room:SEED" or "street:SEED" (random_clutter …), or a file:
/// YAML, or a mesh, which is put on a table (mesh_scene). Answers not_found with the known names.
[[nodiscard]] Result<Scene> find_scene(const std::string& name_or_path, const MeshSceneConfig& mesh = {});

/// Reads a mesh in the unit of its file, turned so that z points up. A closed part that is inside out is turned
/// (turn_outside_out): what can be seen of an object goes by its outward normals. `normals` is empty.
/// @param up  the axis of the file that points up; nullopt: stated_up_axis, or z
/// @return errors of read_any_mesh; corrupt_data for a file without triangles, and for coordinates that are not finite;
/// invalid_argument for a mesh so far from the origin that float rounds it to steps of over a thousandth of its size.
[[nodiscard]] Result<TriangleMesh> read_upright_mesh(const std::filesystem::path& path, std::optional<UpAxis> up);

/// Largest size of an object that stands well within the edges of the table, and below the ceiling of the workspace.
constexpr double kMostMeshLength_m{0.9};
constexpr double kMostMeshWidth_m{0.56};
constexpr double kMostMeshHeight_m{0.37};
/// Smallest size of an object; a smaller one has only a few voxels.
constexpr double kLeastMeshSize_m{0.02};

/// Answers invalid_argument for an object that is larger or smaller than these, with the scale that would fit where
/// there is a likely one.
/// @param size   of the object, in the unit of its file
/// @param scale  metres per unit
[[nodiscard]] Status check_object_size(const Eigen::Vector3d& size, double scale, const std::filesystem::path& file);

/// Puts the mesh on empty_tabletop: the middle of its bounds above the middle of the table, its lowest point on the
/// top. The object is named after its file. Errors: those of read_upright_mesh, MeshSceneConfig and
/// check_object_size.
[[nodiscard]] Result<Scene> mesh_scene(const std::filesystem::path& path, const MeshSceneConfig& config = {});

/// Tells by its extension whether a file is a mesh: PLY, STL, OBJ, GLB, glTF, OFF, DAE.
[[nodiscard]] bool is_mesh_file(const std::filesystem::path& path);

/// Returns the mesh files directly in a folder, sorted by name. Answers io_failure when it cannot be read,
/// invalid_argument when it has no mesh.
[[nodiscard]] Result<std::vector<std::filesystem::path>> mesh_files(const std::filesystem::path& folder);

}  // namespace saccade
