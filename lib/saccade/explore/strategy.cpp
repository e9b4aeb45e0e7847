// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/strategy.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "saccade/core/clock.hpp"

namespace saccade {
namespace {

/// All candidates that the robot may take in index order, none of them judged.
Result<Proposals> candidates_of(const Situation& situation, const ViewSphereConfig& sphere) {
  Proposals proposals;
  Stopwatch stopwatch;
  const Box around = bounds(situation.region);
  SACCADE_TRY(const std::vector<ViewCandidate> candidates, view_sphere(0.5 * (around.min + around.max), sphere));
  const std::vector<Pose> poses = poses_of(candidates);
  proposals.candidates = poses.size();
  proposals.candidates_ms = stopwatch.lap_ms();
  std::vector<std::optional<Refusal>> refusals(poses.size());
  if (situation.test) refusals = situation.test(poses);
  SACCADE_EXPECTS(refusals.size() == poses.size());
  proposals.refused.add(refusals);
  proposals.views.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!refusals[i]) proposals.views.push_back({poses[i], std::nan("")});
  }
  proposals.reachability_ms = stopwatch.lap_ms();
  return proposals;
}

/// Fills in the gains of the first `count` views.
Status judge(Proposals& proposals, std::size_t count, const Situation& situation, const GainFunction& gain) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < count; ++i) poses.push_back(proposals.views[i].T_world_camera);
  SACCADE_TRY(const std::vector<double> gains, gain(situation.map, situation.region, poses, situation.executor));
  if (gains.size() != count) {
    return Error{Errc::size_mismatch, "the gain function must return one value per pose", "strategy"};
  }
  for (std::size_t i = 0; i < count; ++i) proposals.views[i].gain = gains[i];
  return {};
}

}  // namespace

GainFunction ray_gain(const GainConfig& config) {
  return [config](const TsdfSnapshot& map, const Region& region, std::span<const Pose> T_world_camera,
                  const Executor& executor) -> Result<std::vector<double>> {
    SACCADE_TRY(const GainResult result, evaluate_views(map, region, T_world_camera, config, executor));
    return std::vector<double>(result.gains.begin(), result.gains.end());
  };
}

PinholeCamera coarser(const PinholeCamera& camera, int width_px) {
  SACCADE_EXPECTS(width_px >= 1 && width_px <= camera.width);
  const double scale = static_cast<double>(width_px) / camera.width;
  PinholeCamera coarse = camera;
  coarse.width = width_px;
  coarse.height = std::max(1, static_cast<int>(std::lround(camera.height * scale)));
  const double scale_v = static_cast<double>(coarse.height) / camera.height;
  coarse.fx *= scale;
  coarse.fy *= scale_v;
  coarse.cx = (camera.cx + 0.5) * scale - 0.5;
  coarse.cy = (camera.cy + 0.5) * scale_v - 0.5;
  return coarse;
}

Result<Proposals> SphereStrategy::propose(const Situation& situation) const {
  SACCADE_TRY(Proposals proposals, candidates_of(situation, sphere_));
  SACCADE_CHECK(judge(proposals, proposals.views.size(), situation, gain_));
  std::stable_sort(proposals.views.begin(), proposals.views.end(),
                   [](const Proposal& a, const Proposal& b) { return a.gain > b.gain; });
  return proposals;
}

Result<Proposals> RandomStrategy::propose(const Situation& situation) const {
  if (situation.views_of_region >= views_per_region_) return Proposals{};
  SACCADE_TRY(Proposals proposals, candidates_of(situation, sphere_));
  proposals.by_gain = false;
  // A shuffle that is the same everywhere, other than std::shuffle's.
  std::mt19937_64 random{seed_ + situation.region_index};
  for (std::size_t i = proposals.views.size(); i > 1; --i) {
    std::swap(proposals.views[i - 1], proposals.views[random() % i]);
  }
  // Those that were taken, and some that the robot may not reach.
  constexpr std::size_t kSpare{16};
  const std::size_t next = std::min(proposals.views.size(), situation.views_of_region + kSpare);
  SACCADE_CHECK(judge(proposals, next, situation, gain_));
  return proposals;
}

}  // namespace saccade
