// SPDX-License-Identifier: Apache-2.0
#pragma once
// best_views: the best few of many view poses, found without evaluating all.

#include <span>

#include "saccade/views/view_gain.hpp"

namespace saccade {

struct BestViews {
  std::vector<OrderedView> views;  ///< in the order of order_views
  std::size_t poses_evaluated{0};  ///< poses whose gain was computed exactly
  std::uint64_t rays_cast{0};      ///< rays walked one by one
  double prepare_ms{0.0};
  double evaluate_ms{0.0};
};

/// Returns the first `count` of order_views(evaluate_views(…)), exactly. Thesis Algorithm 2 line 13, and the standard
/// method of §3.2.2 where the region is the workspace (docs/decisions/0010-footprints.md). The Footprint of each camera
/// centre and roll bounds the gains of its poses from above. Poses are evaluated in the order of their bounds while
/// these reach the best so far. Tiles of rays are decided one after the other, those likely to score least first, until
/// all are or the bound falls short. Errors of evaluate_views; invalid_argument for a count of 0. The result and the
/// poses evaluated are equal for every thread count. Where distinct voxels are counted, or tiles or footprints are
/// switched off, all poses are evaluated. O(faces that can score, per camera centre and roll + rays of the poses near
/// the best); a few hundred bytes per pose.
[[nodiscard]] Result<BestViews> best_views(const TsdfSnapshot& map, const Region& region,
                                           std::span<const Pose> T_world_camera, std::size_t count,
                                           const GainConfig& config, const Executor& executor);

}  // namespace saccade
