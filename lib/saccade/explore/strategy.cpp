// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/strategy.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/core/clock.hpp"
#include "saccade/explore/candidates.hpp"

namespace saccade {
namespace {

/// All poses of the view sphere that the robot may take in index order, none of them judged.
Result<Proposals> candidates_of(const Situation& situation, const ViewSphereConfig& sphere) {
  Proposals proposals;
  const Stopwatch stopwatch;
  const Box around = bounds(situation.region);
  SACCADE_TRY(const std::vector<ViewCandidate> candidates, view_sphere(0.5 * (around.min + around.max), sphere));
  const std::vector<Pose> poses = poses_of(candidates);
  proposals.candidates = poses.size();
  proposals.candidates_ms = stopwatch.elapsed_ms();
  keep_reachable(poses, situation, proposals);
  return proposals;
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
  SACCADE_CHECK(judge(proposals, 0, proposals.views.size(), situation.region, situation, gain_));
  order_by_gain(proposals.views);
  return proposals;
}

Result<Proposals> RandomStrategy::propose(const Situation& situation) const {
  if (situation.views_of_region >= views_per_region_) return Proposals{};
  SACCADE_TRY(Proposals proposals, candidates_of(situation, sphere_));
  proposals.by_gain = false;
  shuffle(proposals.views, seed_ + situation.region_index);
  // Those that were taken, and some that the robot may not reach.
  constexpr std::size_t kSpare{16};
  const std::size_t next = std::min(proposals.views.size(), situation.views_of_region + kSpare);
  SACCADE_CHECK(judge(proposals, 0, next, situation.region, situation, gain_));
  return proposals;
}

}  // namespace saccade
