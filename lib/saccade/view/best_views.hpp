// SPDX-License-Identifier: Apache-2.0
#pragma once
// best_views: the best few of many view poses, without evaluating them all.

#include <span>

#include "saccade/view/view_gain.hpp"
#include "saccade/view/view_order.hpp"

namespace saccade {

struct BestViews {
  std::vector<RankedView> views;   ///< in the order of order_views
  std::size_t poses_evaluated{0};  ///< poses whose gain was determined to the ray
  std::uint64_t rays_cast{0};      ///< rays walked one by one
  double prepare_ms{0.0};
  double evaluate_ms{0.0};
};

/// The first `count` of order_views(evaluate_views(…)), exactly. All poses are looked over in tiles of rays, which
/// bounds their gains from above, and a few rays of the undecided tiles tell about how much they gain. The most
/// promising poses are evaluated first; of the others tile after tile is decided, those first that seem to score least,
/// until the bound falls short of the best. Errors of evaluate_views; invalid_argument for a count of 0. The same
/// result, and the same poses evaluated, for every thread count. Where distinct voxels are counted, or tiles are
/// switched off, all poses are evaluated.
[[nodiscard]] Result<BestViews> best_views(const TsdfSnapshot& map, const Region& region,
                                           std::span<const Pose> T_world_camera, std::size_t count,
                                           const GainConfig& config, const Executor& executor);

}  // namespace saccade
