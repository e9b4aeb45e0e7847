// SPDX-License-Identifier: Apache-2.0
#pragma once
// sectors_in_frustum: the sectors that a frame may reach.

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"
#include "saccade/map/internal/tsdf_math.hpp"
#include "saccade/map/voxel_index.hpp"

namespace saccade {

/// Returns the sectors of the box around the camera and the corners of its image at the farthest reach.
/// @return invalid_argument when there are too many of them for one frame.
[[nodiscard]] Result<IndexBox> sectors_in_frustum(const tsdf::FusionCamera& camera, const Pose& T_world_camera,
                                                  double reach_m, double voxel_size_m);

}  // namespace saccade
