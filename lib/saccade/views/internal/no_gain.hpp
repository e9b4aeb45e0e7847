// SPDX-License-Identifier: Apache-2.0
#pragma once
// why_no_gain: the first of the reasons for which none of the poses can gain anything.

#include <span>

#include "saccade/views/view_gain.hpp"

namespace saccade {

/// Expects arguments that evaluate_views accepts, and for which every gain is 0. O(voxels of the region + poses).
[[nodiscard]] NoGain why_no_gain(const TsdfSnapshot& map, const Region& region, std::span<const Pose> T_world_camera,
                                 const GainConfig& config);

}  // namespace saccade
