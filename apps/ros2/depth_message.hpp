// SPDX-License-Identifier: Apache-2.0
#pragma once
// Conversion of ROS depth images and cameras to the terms of docs/guides/processes.md: depth_bytes, intrinsics_of.

#include <string>

#include "saccade/io/messages/messages.hpp"

namespace saccade::ros2 {

/// Returns "uint16_mm" for 16UC1 and mono16, "float32_m" for 32FC1. Throws for any other encoding.
[[nodiscard]] const char* depth_format(const messages::Image& image);

/// Returns pixels row by row without padding, least significant byte first. Throws for a bad image.
[[nodiscard]] std::string depth_bytes(const messages::Image& image);

/// Pinhole intrinsics of an image of the given size; pixels have their centres at integers.
struct Intrinsics {
  double fx, fy, cx, cy;
};

/// Returns K without distortion, or P, the camera of rectified images, where `rectified`. Applies binning and the
/// region of interest. Throws for distorted images, and where the size does not fit.
[[nodiscard]] Intrinsics intrinsics_of(const messages::CameraInfo& info, const messages::Image& image, bool rectified);

}  // namespace saccade::ros2
