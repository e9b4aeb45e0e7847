// SPDX-License-Identifier: Apache-2.0
#include "server/show/arm_reading.hpp"

#include <string>
#include <vector>

#include "saccade/io/files/json_io.hpp"

namespace saccade::server {

using nlohmann::json;

json arm_reading_to_json(const UrdfConfig& config) {
  json value = json::object();
  const auto add = [&value](const char* key, const std::string& text) {
    if (!text.empty()) value[key] = text;
  };
  add("base", config.base);
  add("tip", config.tip);
  add("camera_frame", config.camera);
  for (const auto& [name, folder] : config.packages) value["packages"][name] = folder.string();
  for (const auto& path : config.package_paths) value["package_paths"].push_back(path.string());
  if (!config.keep_beyond_tip) value["drop_beyond_tip"] = true;
  if (config.T_world_base) value["T_world_base"] = pose_to_json(*config.T_world_base);
  if (config.T_flange_camera) value["T_flange_camera"] = pose_to_json(*config.T_flange_camera);
  return value;
}

Result<UrdfConfig> arm_reading_from_json(const json& value) {
  UrdfConfig config;
  if (value.is_null()) return config;
  try {
    config.base = value.value("base", "");
    config.tip = value.value("tip", "");
    config.camera = value.value("camera_frame", "");
    const json packages = value.value("packages", json::object());
    for (const auto& [name, folder] : packages.items()) config.packages[name] = folder.get<std::string>();
    const json paths = value.value("package_paths", json::array());
    for (const std::string& path : paths.get<std::vector<std::string>>()) config.package_paths.emplace_back(path);
    config.keep_beyond_tip = !value.value("drop_beyond_tip", false);
    if (value.contains("T_world_base")) {
      SACCADE_TRY(config.T_world_base, pose_from_json(value.at("T_world_base")));
    }
    if (value.contains("T_flange_camera")) {
      SACCADE_TRY(config.T_flange_camera, pose_from_json(value.at("T_flange_camera")));
    }
  } catch (const json::exception& e) {
    return Error{Errc::corrupt_data, message_of(e), "arm_reading"};
  }
  return config;
}

}  // namespace saccade::server
