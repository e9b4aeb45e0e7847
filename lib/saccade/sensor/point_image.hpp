// SPDX-License-Identifier: Apache-2.0
#pragma once
// PointImage: a depth image with normals, in planes that vectors of pixels load and gather from.

#include "saccade/core/executor.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// A depth image as points with normals, camera frame. The point of pixel (u, v) is camera.ray(u, v) · z.
struct PointImage {
  Image<float> z;   ///< metres; zero where there is no return
  Image<float> nx;  ///< (nx, ny, nz): unit normal, towards the camera; zero where unknown
  Image<float> ny;
  Image<float> nz;
};

/// Computes the points and normals of a depth image. Normals come from differences across a few pixels, and are missing
/// across depth steps. Returns outside the camera's range are dropped. O(pixels). Neither threads nor simd_target()
/// change a bit of the result.
[[nodiscard]] PointImage to_points(const DepthImage& depth, const PinholeCamera& camera, const Executor& executor);

}  // namespace saccade
