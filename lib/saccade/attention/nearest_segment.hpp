// SPDX-License-Identifier: Apache-2.0
#pragma once
// nearest_segments: which segment owns the point that is nearest to a place.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/attention/segmented_points.hpp"
#include "saccade/core/executor.hpp"

namespace saccade {

/// For each place the segment of the nearest of all points, of equally near ones the first; kUnlabelled where that
/// point is in no segment, or there is no point. FindNear of thesis Algorithm 4, line 8. Expects finite places.
/// O(points + places) for places within kNearSurface_m of a point, O(points) for each of the others. The thread count
/// never changes the result.
[[nodiscard]] std::vector<std::uint32_t> nearest_segments(const SegmentedPoints& points,
                                                          std::span<const Eigen::Vector3d> places_m,
                                                          const Executor& executor);
constexpr double kNearSurface_m{0.04};

}  // namespace saccade
