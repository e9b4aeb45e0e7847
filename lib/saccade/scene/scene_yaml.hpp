// SPDX-License-Identifier: Apache-2.0
#pragma once
// Scenes from YAML files, the scenes that come with Saccade, and an object of the user's, read from a mesh file, on a
// table. The format: docs/scenes.md.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/names.hpp"
#include "saccade/scene/scene.hpp"

namespace saccade {

/// Reads a scene. Mesh paths are taken relative to `folder`. corrupt_data for what is no YAML, an unknown or missing
/// key, or a value of the wrong kind, with line and column; what read_any_mesh and Scene::validate return.
[[nodiscard]] Result<Scene> parse_scene(std::string_view yaml, const std::filesystem::path& folder = {});
/// The same from a file.
[[nodiscard]] Result<Scene> read_scene(const std::filesystem::path& path);

struct BuiltinScene {
  std::string_view name;
  std::string_view yaml;
};
/// The files of scenes/, in alphabetical order.
[[nodiscard]] const std::vector<BuiltinScene>& builtin_scenes();

/// A built-in scene by its name, "clutter:SEED" (random_clutter), or a file. not_found with the known names.
[[nodiscard]] Result<Scene> find_scene(const std::string& name_or_path);

enum class UpAxis : std::uint8_t { y, z };
inline constexpr auto kUpAxisNames = make_names<UpAxis>({{UpAxis::y, "y"}, {UpAxis::z, "z"}});

struct MeshSceneConfig {
  double scale{1.0};           ///< metres per unit of the file
  std::optional<UpAxis> up{};  ///< default: y for glTF (.glb, .gltf), whose specification says so; z for all others

  [[nodiscard]] Status validate() const;
};

/// Objects stand this far within the edges of the table, and below the ceiling of the workspace, or they are refused.
constexpr double kMostMeshLength_m{0.9};
constexpr double kMostMeshWidth_m{0.56};
constexpr double kMostMeshHeight_m{0.37};
/// Smaller ones are a few voxels.
constexpr double kLeastMeshSize_m{0.02};

/// empty_tabletop with the mesh on it: middle of its bounds above the middle of the table, its lowest point on the top.
/// Called by the name of its file. Errors: those of read_any_mesh and MeshSceneConfig; corrupt_data for coordinates
/// that are not finite; invalid_argument, with the scale that would do where there is a likely one, for an object that
/// is too large or too small.
[[nodiscard]] Result<Scene> mesh_scene(const std::filesystem::path& path, const MeshSceneConfig& config = {});

/// By its extension: PLY, STL, OBJ, GLB, glTF, OFF, DAE.
[[nodiscard]] bool is_mesh_file(const std::filesystem::path& path);

/// The mesh files right in a folder, in order of their names.
/// io_failure when it cannot be read; invalid_argument when there is none.
[[nodiscard]] Result<std::vector<std::filesystem::path>> mesh_files(const std::filesystem::path& folder);

}  // namespace saccade
