// SPDX-License-Identifier: Apache-2.0
#pragma once
// verified_closure: ICP between two keyframes that may show the same place.

#include <optional>
#include <vector>

#include "saccade/loops/loop_closer.hpp"

namespace saccade::internal::loops {

/// Aligns the new depth image to the old surface, from where tracking says that it is and from the old keyframe's own
/// pose. Returns the pose in best agreement that passes every limit; nullopt where neither does. O(pixels ·
/// iterations).
[[nodiscard]] std::optional<Pose> verified_closure(const PointImage& old_surface, const PointImage& measured,
                                                   const PinholeCamera& camera, const Pose& T_old_new_tracked,
                                                   const LoopConfig& config, const Executor& executor);

/// Returns the way from a keyframe to every other along the edges of the graph: closures have no length.
/// O(nodes · edges) at most.
[[nodiscard]] std::vector<double> ways_from(std::size_t node, std::size_t nodes, const std::vector<PoseEdge>& edges);

}  // namespace saccade::internal::loops
