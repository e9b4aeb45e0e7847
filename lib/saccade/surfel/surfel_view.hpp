// SPDX-License-Identifier: Apache-2.0
#pragma once
// view_surfels: which surfel of a cloud each pixel of a camera sees.

#include <Eigen/Core>
#include <span>

#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"
#include "saccade/surfel/surfel_map.hpp"

namespace saccade {

/// Discs in the world frame; as many of each.
struct SurfelDiscs {
  std::span<const Eigen::Vector3f> positions_m;
  std::span<const Eigen::Vector3f> normals;  ///< unit length
  std::span<const float> radii_m;
};

struct SurfelView {
  Image<SurfelId> seen;  ///< index of the disc, or kNoSurfel
  Image<float> depth;    ///< where the pixel's ray meets it, metres along z; 0: nowhere
};

/// Discs overlap, and noise puts one a little before the other. So of those that a pixel's ray meets no farther behind
/// the nearest than their own radius, it sees the one whose centre is nearest to where the ray meets it, of equal ones
/// the first. Discs are seen from the front alone; the camera's range plays no part.
/// The thread count never changes a bit of the result. O(discs + covered pixels).
[[nodiscard]] SurfelView view_surfels(const SurfelDiscs& discs, const PinholeCamera& camera, const Pose& T_world_camera,
                                      const Executor& executor);

}  // namespace saccade
