// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/contour_strategies.hpp"

#include <algorithm>

#include "saccade/core/clock.hpp"
#include "saccade/explore/candidates.hpp"
#include "saccade/view/best_views.hpp"

namespace saccade {
namespace {

/// Views that are proposed at a time.
constexpr std::size_t kAtATime{64};

/// Without those that were attempted.
void drop_attempted(Proposals& proposals, const Situation& situation) {
  if (!situation.attempted) return;
  std::erase_if(proposals.views, [&](const Proposal& view) { return situation.attempted(view.T_world_camera); });
}

}  // namespace

ContourCandidates::ContourCandidates(const ContourConfig& contours, ContourViewConfig views)
    : views_{std::move(views)}, contours_{LiveContours::create(contours).value()} {
  SACCADE_EXPECTS(views_.validate().ok());
}

Result<Proposals> ContourCandidates::reachable(const Situation& situation) const {
  Proposals proposals;
  Stopwatch stopwatch;
  std::vector<ContourPoint> points;
  {
    const std::scoped_lock lock{mutex_};
    contours_.update(situation.map, situation.executor);
    points = contours_.points();
  }
  SACCADE_TRY(const std::vector<Pose> poses, contour_views(points, views_));
  proposals.candidates = poses.size();
  proposals.candidates_ms = stopwatch.elapsed_ms();
  keep_reachable(poses, situation, proposals);
  return proposals;
}

Result<Proposals> StandardStrategy::propose(const Situation& situation) const {
  SACCADE_TRY(Proposals proposals, candidates_.reachable(situation));
  drop_attempted(proposals, situation);
  if (proposals.views.empty()) return proposals;
  std::vector<Pose> poses;
  for (const Proposal& view : proposals.views) poses.push_back(view.T_world_camera);
  SACCADE_TRY(const BestViews best,
              best_views(situation.map, situation.region, poses, kAtATime, gain_, situation.executor));
  proposals.evaluated = poses.size();
  proposals.complete = best.views.size() == poses.size();
  proposals.views.clear();
  for (const RankedView& view : best.views) {
    proposals.views.push_back({view.T_world_camera, static_cast<double>(view.gain)});
  }
  return proposals;
}

Result<Proposals> RandomContourStrategy::propose(const Situation& situation) const {
  SACCADE_TRY(Proposals proposals, candidates_.reachable(situation));
  proposals.by_gain = false;
  // Candidates are others after every view, so that every view has an order of its own.
  constexpr std::uint64_t kViewStride{1'000'003};
  shuffle(proposals.views, seed_ + kViewStride * situation.views_of_region);
  drop_attempted(proposals, situation);
  proposals.complete = proposals.views.size() <= kAtATime;
  if (!proposals.complete) proposals.views.resize(kAtATime);
  SACCADE_CHECK(judge(proposals, 0, proposals.views.size(), situation.region, situation, gain_));
  return proposals;
}

}  // namespace saccade
