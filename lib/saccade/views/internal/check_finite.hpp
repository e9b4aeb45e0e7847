// SPDX-License-Identifier: Apache-2.0
#pragma once
// check_finite: checks poses before their gain is computed.

#include <span>
#include <string>

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// Answers invalid_argument for a pose that contains NaN or infinity, with its index and the name of the gain.
[[nodiscard]] inline Status check_finite(std::span<const Pose> T_world_camera, const char* who) {
  for (std::size_t i = 0; i < T_world_camera.size(); ++i) {
    if (T_world_camera[i].matrix().allFinite()) continue;
    return Error{Errc::invalid_argument, "pose " + std::to_string(i) + " contains NaN or infinity", who};
  }
  return {};
}

}  // namespace saccade
