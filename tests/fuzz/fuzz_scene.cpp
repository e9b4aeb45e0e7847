// SPDX-License-Identifier: Apache-2.0
// Feeds the reader of scene files, and makes the triangles of what it accepts.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "saccade/scene/scene_yaml.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  if (text.find("path") != std::string_view::npos) return 0;  // meshes are files; they have readers of their own
  const auto scene = saccade::parse_scene(text);
  if (!scene) return 0;
  if (!scene->validate()) std::abort();
  const auto meshes = saccade::true_meshes(*scene);
  if (meshes && meshes->size() != scene->objects.size()) std::abort();
  return 0;
}
