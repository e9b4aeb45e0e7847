// SPDX-License-Identifier: Apache-2.0
#pragma once
// check_frame: what must hold of a depth image, its camera and its pose before fusion.

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// Answers size_mismatch where depth or colour and camera disagree, invalid_argument for a bad camera or pose. `color`
/// may be null.
[[nodiscard]] Status check_frame(const PinholeCamera& camera, const DepthImage& depth, const Pose& T_world_camera,
                                 const ColorImage* color);

}  // namespace saccade
