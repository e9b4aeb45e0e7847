// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "saccade/core/clock.hpp"
#include "saccade/view/best_views.hpp"

namespace saccade {

void keep_reachable(std::span<const Pose> T_world_camera, const Situation& situation, Proposals& proposals) {
  const Stopwatch stopwatch;
  std::vector<std::optional<Refusal>> refusals(T_world_camera.size());
  if (situation.test) refusals = situation.test(T_world_camera);
  SACCADE_EXPECTS(refusals.size() == T_world_camera.size());
  proposals.refused.add(refusals);
  for (std::size_t i = 0; i < T_world_camera.size(); ++i) {
    if (!refusals[i]) proposals.views.push_back({T_world_camera[i], std::nan("")});
  }
  proposals.reachability_ms += stopwatch.elapsed_ms();
}

Status judge(Proposals& proposals, std::size_t first, std::size_t end, const Region& region, const Situation& situation,
             const GainFunction& gain) {
  std::vector<Pose> poses;
  for (std::size_t i = first; i < end; ++i) poses.push_back(proposals.views[i].T_world_camera);
  SACCADE_TRY(const std::vector<double> gains, gain(situation.map, region, poses, situation.executor));
  if (gains.size() != poses.size()) {
    return Error{Errc::size_mismatch, "the gain function must return one value per pose", "strategy"};
  }
  for (std::size_t i = first; i < end; ++i) proposals.views[i].gain = gains[i - first];
  proposals.evaluated += poses.size();
  return {};
}

Status keep_best(Proposals& proposals, std::size_t count, const Region& region, const Situation& situation,
                 const GainConfig& gain) {
  std::vector<Proposal> attempted;
  std::vector<Pose> others;
  for (const Proposal& view : proposals.views) {
    if (situation.attempted && situation.attempted(view.T_world_camera)) {
      attempted.push_back(view);
    } else {
      others.push_back(view.T_world_camera);
    }
  }
  proposals.views = std::move(attempted);
  if (!proposals.views.empty()) {
    SACCADE_CHECK(judge(proposals, 0, proposals.views.size(), region, situation, ray_gain(gain)));
  }
  if (others.empty()) return {};
  SACCADE_TRY(const BestViews best, best_views(situation.map, region, others, count, gain, situation.executor));
  proposals.evaluated += others.size();
  proposals.complete = best.views.size() == others.size();
  std::vector<Proposal> kept;
  for (const RankedView& view : best.views) kept.push_back({view.T_world_camera, static_cast<double>(view.gain)});
  proposals.views.insert(proposals.views.begin(), kept.begin(), kept.end());
  return {};
}

void order_by_gain(std::span<Proposal> views) {
  std::stable_sort(views.begin(), views.end(), [](const Proposal& a, const Proposal& b) { return a.gain > b.gain; });
}

void shuffle(std::span<Proposal> views, std::uint64_t seed) {
  std::mt19937_64 random{seed};
  for (std::size_t i = views.size(); i > 1; --i) std::swap(views[i - 1], views[random() % i]);
}

}  // namespace saccade
