// SPDX-License-Identifier: Apache-2.0
#pragma once
// Depth images and cameras as ROS describes them, in the words of docs/processes.md: depth_bytes, intrinsics_of.

#include <string>

#include "saccade/io/messages/messages.hpp"

namespace saccade::ros2 {

/// "uint16_mm" for 16UC1 and mono16, "float32_m" for 32FC1. Throws for any other encoding.
[[nodiscard]] const char* depth_format(const messages::Image& image);

/// Pixels row by row without padding, the least significant byte first. Throws what is wrong with the image.
[[nodiscard]] std::string depth_bytes(const messages::Image& image);

/// The pinhole of an image of the given size; pixels have their centres at integers.
struct Intrinsics {
  double fx, fy, cx, cy;
};

/// K where there is no distortion; P, the camera of rectified images, where `rectified`. Binning and the region of
/// interest are applied. Throws for distorted images, and where the size does not fit.
[[nodiscard]] Intrinsics intrinsics_of(const messages::CameraInfo& info, const messages::Image& image, bool rectified);

}  // namespace saccade::ros2
