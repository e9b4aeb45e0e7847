// SPDX-License-Identifier: Apache-2.0
#pragma once
// MissingPoint, missing_of, visible_from, is_in_picture: what a map does not have yet of the true objects, and the
// views that would show it. What the oracles share.

#include <span>
#include <vector>

#include "saccade/sensor/pinhole_camera.hpp"
#include "saccade/trial/metrics.hpp"

namespace saccade {

constexpr std::size_t kOraclePoints{3000};

/// A point of a true surface, and where it faces.
struct MissingPoint {
  Eigen::Vector3d p_world;
  Eigen::Vector3d normal_world;
};

/// Points that the map's mesh does not have (Metrics::coverage), out of about kOraclePoints that can be observed.
[[nodiscard]] std::vector<MissingPoint> missing_of(const Truth& truth, const TsdfSnapshot& map,
                                                   const Executor& executor);

/// Indices of the points that can be seen from a camera's centre, however the camera is turned: 80° from their normal
/// at most, nothing true in between.
[[nodiscard]] std::vector<std::size_t> visible_from(const Eigen::Vector3d& center,
                                                    std::span<const MissingPoint> missing, const RayScene& scene);

/// Whether a point lies in the camera's image and range.
[[nodiscard]] bool is_in_picture(const Eigen::Vector3d& p_world, const Pose& T_camera_world,
                                 const PinholeCamera& camera);

}  // namespace saccade
