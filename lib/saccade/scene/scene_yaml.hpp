// SPDX-License-Identifier: Apache-2.0
#pragma once
// Scenes from YAML files, the scenes that come with Saccade. The format: docs/scenes.md.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

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

}  // namespace saccade
