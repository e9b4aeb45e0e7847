// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/attention_strategy.hpp"

#include <algorithm>
#include <utility>

#include "saccade/core/clock.hpp"
#include "saccade/explore/candidates.hpp"

namespace saccade {
namespace {

/// Views of a segment, among those that were judged.
struct SegmentViews {
  std::uint32_t segment;
  std::size_t first;
  std::size_t end;
  double gain;  ///< of the best view worth trying
};

/// Leaves the views of one segment.
void keep_only(const SegmentViews& chosen, Proposals& judged) {
  judged.views.resize(chosen.end);
  judged.views.erase(judged.views.begin(), judged.views.begin() + static_cast<std::ptrdiff_t>(chosen.first));
  judged.segment = chosen.segment;
  judged.complete = false;
}

}  // namespace

AttentionStrategy::AttentionStrategy(const ObjectAttentionConfig& attention, ContourViewConfig views, GainFunction gain)
    : reach_m_{attention.reach_m},
      rival_share_{attention.rival_share},
      views_{std::move(views)},
      gain_{std::move(gain)},
      attention_{LiveObjectAttention::create(attention).value()} {
  SACCADE_EXPECTS(views_.validate().ok());
}

/// Lines 8 to 11 for one segment; its views come behind those that were judged before, in their order.
Status AttentionStrategy::judge_segment(const ObjectAttention& seen, std::uint32_t segment,
                                        std::span<const std::uint32_t> contours, const Situation& situation,
                                        Proposals& judged) const {
  Stopwatch stopwatch;
  std::vector<ContourPoint> points;
  for (const std::uint32_t contour : contours) points.push_back(seen.contours[contour]);
  SACCADE_TRY(const std::vector<Pose> poses, contour_views(points, views_));
  judged.candidates_ms += stopwatch.lap_ms();
  const std::size_t first = judged.views.size();
  keep_reachable(poses, situation, judged);
  SACCADE_CHECK(judge(judged, first, judged.views.size(), seen.surroundings(segment, reach_m_), situation, gain_));
  order_by_gain(std::span{judged.views}.subspan(first));
  return {};
}

Result<Proposals> AttentionStrategy::propose(const Situation& situation) const {
  const std::scoped_lock lock{mutex_};
  SACCADE_TRY(ObjectAttention looked, attention_.look(situation.map, situation.executor));
  const auto seen = std::make_shared<const ObjectAttention>(std::move(looked));
  const std::vector<std::vector<std::uint32_t>> contours_of = seen->contours_of_segments();
  Proposals judged;
  judged.attention = seen;
  judged.candidates = seen->contours.size() * views_.views_per_point();
  judged.candidates_ms = seen->contours_ms;
  judged.segmentation_ms = seen->segmentation_ms;
  judged.saliency_ms = seen->saliency_ms;
  std::optional<SegmentViews> chosen;
  double least_saliency{0.0};  // of a rival
  for (std::size_t i = 0; i < seen->order.size(); ++i) {
    const std::uint32_t segment = seen->order[i];
    const bool is_scrap = i + seen->scraps >= seen->order.size();
    if (chosen && (is_scrap || seen->saliency[segment].value < least_saliency)) break;
    if (contours_of[segment].empty()) continue;
    const std::size_t first = judged.views.size();
    SACCADE_CHECK(judge_segment(*seen, segment, contours_of[segment], situation, judged));
    const auto best = std::find_if(judged.views.begin() + static_cast<std::ptrdiff_t>(first), judged.views.end(),
                                   [&](const Proposal& view) { return situation.is_worth_trying(view); });
    if (best == judged.views.end()) continue;
    if (!chosen) least_saliency = rival_share_ * seen->saliency[segment].value;
    if (!chosen || best->gain > chosen->gain) chosen = SegmentViews{segment, first, judged.views.size(), best->gain};
  }
  if (chosen) {
    keep_only(*chosen, judged);
    judged.gained = seen->surroundings(chosen->segment, reach_m_);
  } else {
    order_by_gain(judged.views);
  }
  return judged;
}

}  // namespace saccade
