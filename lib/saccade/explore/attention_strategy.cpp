// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/attention_strategy.hpp"

#include <optional>
#include <utility>

#include "saccade/core/clock.hpp"
#include "saccade/explore/candidates.hpp"

namespace saccade {
namespace {

constexpr std::size_t kNextViews{16};  // views of the segment that is next

/// The views of a segment that the robot can take, and what the best of them gains.
struct SegmentViews {
  std::uint32_t segment{0};
  std::vector<Proposal> views;
  double gain{0.0};
};

}  // namespace

AttentionStrategy::AttentionStrategy(const ObjectAttentionConfig& attention, ContourViewConfig views,
                                     const GainConfig& gain)
    : reach_m_{attention.reach_m},
      rival_share_{attention.rival_share},
      views_{std::move(views)},
      gain_{gain},
      attention_{LiveObjectAttention::create(attention).value()} {
  SACCADE_EXPECTS(views_.validate().ok());
}

Result<Proposals> AttentionStrategy::views_of(const ObjectAttention& seen, std::span<const std::uint32_t> contours,
                                              const Situation& situation) const {
  const Stopwatch stopwatch;
  std::vector<ContourPoint> points;
  for (const std::uint32_t contour : contours) points.push_back(seen.contours[contour]);
  SACCADE_TRY(const std::vector<Pose> poses, contour_views(points, views_));
  Proposals proposals;
  proposals.candidates_ms = stopwatch.elapsed_ms();
  keep_reachable(poses, situation, proposals);
  return proposals;
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
    SACCADE_TRY(Proposals of_segment, views_of(*seen, contours_of[segment], situation));
    std::vector<Proposal> views = of_segment.views;
    SACCADE_CHECK(keep_best(of_segment, 1, seen->surroundings(segment, reach_m_), situation, gain_));
    judged.candidates_ms += of_segment.candidates_ms;
    judged.reachability_ms += of_segment.reachability_ms;
    judged.refused.add(of_segment.refused);
    judged.evaluated += of_segment.evaluated;
    judged.views.insert(judged.views.end(), of_segment.views.begin(), of_segment.views.end());
    if (of_segment.views.empty() || !situation.is_worth_trying(of_segment.views.front())) continue;
    const double gain = of_segment.views.front().gain;
    if (!chosen) least_saliency = rival_share_ * seen->saliency[segment].value;
    if (!chosen || gain > chosen->gain) chosen = SegmentViews{segment, std::move(views), gain};
  }
  if (chosen) {
    Proposals next;
    next.views = std::move(chosen->views);
    const Region gained = seen->surroundings(chosen->segment, reach_m_);
    SACCADE_CHECK(keep_best(next, kNextViews, gained, situation, gain_));
    judged.views = std::move(next.views);
    judged.segment = chosen->segment;
    judged.gained = gained;
    judged.complete = false;
  }
  order_by_gain(judged.views);
  return judged;
}

}  // namespace saccade
