// SPDX-License-Identifier: Apache-2.0
#pragma once
// nearest_points: for each point of one cloud the nearest point of another.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"

namespace saccade {

/// Stands for a point that has no other near it.
inline constexpr std::uint32_t kNoNearPoint{std::numeric_limits<std::uint32_t>::max()};

/// Returns for each point of `from_m` the index of the nearest point of `to_m` that is at most `within_m` away, the
/// smallest index where several are equally near; kNoNearPoint where there is none. Both are in one frame, metres.
/// Points that are not finite are near to nothing. Squared distances are compared in single precision. Expects at most
/// 2³² − 1 points in each. The thread count never changes the result. O((n + m) log m) for n and m points.
[[nodiscard]] std::vector<std::uint32_t> nearest_points(std::span<const Eigen::Vector3f> from_m,
                                                        std::span<const Eigen::Vector3f> to_m, float within_m,
                                                        const Executor& executor);

}  // namespace saccade
