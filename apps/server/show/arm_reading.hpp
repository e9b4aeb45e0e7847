// SPDX-License-Identifier: Apache-2.0
#pragma once
// How an arm's description was read, as a run keeps it: "arm_reading" in run.json.

#include <nlohmann/json.hpp>

#include "saccade/arm/urdf.hpp"

namespace saccade::server {

/// What differs from the defaults: base, tip, camera_frame, packages, drop_beyond_tip, T_world_base, T_flange_camera.
/// Empty: nothing.
[[nodiscard]] nlohmann::json arm_reading_to_json(const UrdfConfig& config);
/// The inverse; null is the defaults. corrupt_data for anything else.
[[nodiscard]] Result<UrdfConfig> arm_reading_from_json(const nlohmann::json& value);

}  // namespace saccade::server
