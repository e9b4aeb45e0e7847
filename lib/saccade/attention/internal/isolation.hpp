// SPDX-License-Identifier: Apache-2.0
#pragma once
// isolated_points: the points far from all other segments.

#include <cstdint>
#include <vector>

#include "saccade/attention/segmented_points.hpp"
#include "saccade/core/executor.hpp"

namespace saccade {

/// Returns 1 for every point c ∈ S farther than `distance_m` from all points o ∉ S, otherwise 0, in the order of
/// positions_m(): the set counted in eq. 3.11. (The text before it says "at least"; the equation is used.)  Expects a
/// positive distance. Cells of that edge length whose surroundings hold one segment are decided as a whole. Points of
/// other cells are looked up in a tree whose nodes know whether all their points are of one segment, so that neither
/// duplicates nor a large distance make it slow. O(points + near · log near) for `near` points in the surroundings of
/// others.
[[nodiscard]] std::vector<std::uint8_t> isolated_points(const SegmentedPoints& points, double distance_m,
                                                        const Executor& executor);

}  // namespace saccade
