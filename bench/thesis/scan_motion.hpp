// SPDX-License-Identifier: Apache-2.0
#pragma once
// scan_motion: the way of the camera in the arm's hand for the first observation of a table (thesis §2.4.1).

#include <vector>

#include "saccade/arm/arm_model.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/scene/scene.hpp"

namespace saccade::thesis {

constexpr double kFrameRate_hz{30.0};

/// T_world_camera frame by frame while the arm goes from the table's left end up over its middle and down before it,
/// always looking at its middle. It stops at the corners of its way.
/// @param pace share of the speed that the arm could drive with; positive
/// @return errors of PlannedArm::create; not_found where the arm has no way from one corner to the next.
[[nodiscard]] Result<std::vector<Pose>> scan_motion(const Scene& scene, const ArmModel& arm, double pace);

}  // namespace saccade::thesis
