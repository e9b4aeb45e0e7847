// SPDX-License-Identifier: Apache-2.0
#pragma once
// point_spacing_m: how far apart the points of a cloud are.

#include <Eigen/Core>
#include <optional>
#include <span>

#include "saccade/core/executor.hpp"

namespace saccade {

/// Median distance from a point to its nearest neighbour at another place, metres; points that are not finite are
/// passed over. nullopt with fewer than two places. The thread count never changes a bit of it. O(n log n).
[[nodiscard]] std::optional<double> point_spacing_m(std::span<const Eigen::Vector3f> positions_m,
                                                    const Executor& executor);

}  // namespace saccade
