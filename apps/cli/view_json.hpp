// SPDX-License-Identifier: Apache-2.0
#pragma once
// One view of an exploration or an update: as JSON, and its arm to be drawn.

#include <nlohmann/json.hpp>
#include <optional>

#include "saccade/explore/exploration.hpp"
#include "saccade/report/robot_drawing.hpp"
#include "saccade/robot/arm_model.hpp"

namespace saccade::cli {

[[nodiscard]] nlohmann::json configuration_json(const std::optional<Configuration>& q);

/// Reasons that occurred.
[[nodiscard]] nlohmann::json refused_json(const RefusalCounts& refused);

/// An entry of `result.views`; what is measured against the truth or in the map is null.
[[nodiscard]] nlohmann::json view_json(const ExploredView& view, std::size_t index);

/// `attention` of an entry: what the view was chosen for; null for strategies that do not look for objects.
[[nodiscard]] nlohmann::json attention_json(const Proposals& proposals);

/// The arm at the end of its camera's path; none where there is no arm.
[[nodiscard]] std::optional<RobotDrawing> drawing_of(const ArmModel* arm, const std::optional<Configuration>& q,
                                                     const std::vector<Eigen::Vector3d>& path);

}  // namespace saccade::cli
