// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/contour_strategies.hpp"

#include "saccade/core/clock.hpp"
#include "saccade/explore/candidates.hpp"

namespace saccade {
namespace {

/// Views that are proposed at a time.
constexpr std::size_t kAtATime{64};

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
  SACCADE_CHECK(keep_best(proposals, kAtATime, situation.region, situation, gain_));
  return proposals;
}

Result<Proposals> RandomContourStrategy::propose(const Situation& situation) const {
  SACCADE_TRY(Proposals proposals, candidates_.reachable(situation));
  proposals.by_gain = false;
  // Candidates are others after every view, so that every view has an order of its own.
  constexpr std::uint64_t kViewStride{1'000'003};
  shuffle(proposals.views, seed_ + kViewStride * situation.views_of_region);
  if (situation.attempted) {
    std::erase_if(proposals.views, [&](const Proposal& view) { return situation.attempted(view.T_world_camera); });
  }
  proposals.complete = proposals.views.size() <= kAtATime;
  if (!proposals.complete) proposals.views.resize(kAtATime);
  SACCADE_CHECK(judge(proposals, 0, proposals.views.size(), situation.region, situation, gain_));
  return proposals;
}

}  // namespace saccade
