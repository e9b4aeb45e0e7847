// SPDX-License-Identifier: Apache-2.0
#pragma once
// check_finite: poses that a gain can be asked about.

#include <span>
#include <string>

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// invalid_argument for a pose that contains NaN or infinity, with its index and who refuses it.
[[nodiscard]] inline Status check_finite(std::span<const Pose> T_world_camera, const char* who) {
  for (std::size_t i = 0; i < T_world_camera.size(); ++i) {
    if (T_world_camera[i].matrix().allFinite()) continue;
    return Error{Errc::invalid_argument, "pose " + std::to_string(i) + " contains NaN or infinity", who};
  }
  return {};
}

}  // namespace saccade
