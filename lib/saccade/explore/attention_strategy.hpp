// SPDX-License-Identifier: Apache-2.0
#pragma once
// AttentionStrategy: the next best view of the most salient segment. Thesis §3.1, Algorithm 4.

#include <mutex>

#include "saccade/explore/object_attention.hpp"
#include "saccade/explore/strategy.hpp"

namespace saccade {

/// The best few views of the contours of what looks like an object: of the most salient segment that has a view worth
/// trying, or of that of its rivals (ObjectAttentionConfig::rival_share) whose best view gains more, by decreasing
/// gain. Asked again when none of them could be reached, it proposes more, then those of the next segment. Gains count
/// unknown voxels in the segment's surroundings alone (ObjectAttention::surroundings). When no segment has a view worth
/// trying, the best of each and those that were attempted are returned, with `complete`. Follows the map from call to
/// call; what it proposes depends on the situation alone. It does not heed the bounds of the situation's region:
/// salient is what lies in the map's workspace.
class AttentionStrategy final : public Strategy {
 public:
  /// Expects valid configurations. Gains are counted rays (ray_gain).
  AttentionStrategy(const ObjectAttentionConfig& attention, ContourViewConfig views, const GainConfig& gain);
  [[nodiscard]] Result<Proposals> propose(const Situation& situation) const override;

 private:
  /// Views of a segment that the robot can take.
  [[nodiscard]] Result<Proposals> views_of(const ObjectAttention& seen, std::span<const std::uint32_t> contours,
                                           const Situation& situation) const;

  double reach_m_;
  double rival_share_;
  ContourViewConfig views_;
  GainConfig gain_;
  mutable std::mutex mutex_;
  mutable LiveObjectAttention attention_;  ///< what it keeps saves time, and changes nothing
};

}  // namespace saccade
