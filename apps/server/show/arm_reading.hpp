// SPDX-License-Identifier: Apache-2.0
#pragma once
// Settings for reading an arm's description, as stored in a run: "arm_reading" in run.json.

#include <nlohmann/json.hpp>

#include "saccade/arm/urdf.hpp"

namespace saccade::server {

/// Returns the settings that differ from the defaults: base, tip, camera_frame, packages, package_paths,
/// drop_beyond_tip, T_world_base, T_flange_camera. Empty without differences.
[[nodiscard]] nlohmann::json arm_reading_to_json(const UrdfConfig& config);
/// Reads the settings back; null gives the defaults. Answers corrupt_data for anything else.
[[nodiscard]] Result<UrdfConfig> arm_reading_from_json(const nlohmann::json& value);

}  // namespace saccade::server
