// SPDX-License-Identifier: Apache-2.0
#pragma once
// MissingPoint, missing_of, visible_from, is_in_picture: parts of the true objects that a map lacks, and the views that
// would show them. Shared by the oracles.

#include <span>
#include <vector>

#include "saccade/sensor/pinhole_camera.hpp"
#include "saccade/trial/metrics.hpp"

namespace saccade {

constexpr std::size_t kOraclePoints{3000};

/// Point of a true surface, with its normal.
struct MissingPoint {
  Eigen::Vector3d p_world;
  Eigen::Vector3d normal_world;
};

/// Returns the points that the map's mesh lacks (Metrics::coverage), out of about kOraclePoints observable ones.
[[nodiscard]] std::vector<MissingPoint> missing_of(const GroundTruth& truth, const TsdfSnapshot& map,
                                                   const Executor& executor);

/// Returns the indices of the points visible from a camera's centre in some orientation: at most 80° from their normal,
/// with no true surface in between.
[[nodiscard]] std::vector<std::size_t> visible_from(const Eigen::Vector3d& center,
                                                    std::span<const MissingPoint> missing, const RayScene& scene);

/// Tells whether a point lies in the camera's image and range.
[[nodiscard]] bool is_in_picture(const Eigen::Vector3d& p_world, const Pose& T_camera_world,
                                 const PinholeCamera& camera);

}  // namespace saccade
