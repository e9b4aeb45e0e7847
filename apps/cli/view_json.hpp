// SPDX-License-Identifier: Apache-2.0
#pragma once
// drawing_of: an arm to be drawn in the picture of a view.

#include <optional>
#include <vector>

#include "saccade/arm/arm_model.hpp"
#include "saccade/report/robot_drawing.hpp"

namespace saccade::cli {

/// The arm at the end of its camera's path; none where there is no arm.
[[nodiscard]] std::optional<RobotDrawing> drawing_of(const ArmModel* arm, const std::optional<Configuration>& q,
                                                     const std::vector<Eigen::Vector3d>& path);

}  // namespace saccade::cli
