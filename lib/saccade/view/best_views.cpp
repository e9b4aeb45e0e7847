// SPDX-License-Identifier: Apache-2.0
#include "saccade/view/best_views.hpp"

#include <algorithm>
#include <numeric>

#include "saccade/core/clock.hpp"
#include "saccade/view/gain_problem.hpp"

namespace saccade {
namespace {

constexpr int kLookOverPx{16};        // tiles of the first look
constexpr std::size_t kBatch{4};      // jobs before bounds are compared with a new best; fixed: see best_views
constexpr std::size_t kLookGrain{4};  // jobs

bool better(const RankedView& a, const RankedView& b) { return a.gain != b.gain ? a.gain > b.gain : a.index < b.index; }

/// The best so many views that were evaluated.
class Podium {
 public:
  Podium(std::size_t places, std::span<const Pose> poses) : places_{places}, poses_{poses} {}

  void add(std::size_t pose, std::uint64_t gain) {
    const RankedView view{pose, gain, poses_[pose]};
    views_.insert(std::upper_bound(views_.begin(), views_.end(), view, better), view);
    if (views_.size() > places_) views_.pop_back();
  }
  /// What a pose must gain at least to get on it. At equal gains the index decides.
  [[nodiscard]] std::uint64_t entry(std::size_t pose) const {
    return views_.size() < places_ ? 0 : views_.back().gain + (pose > views_.back().index ? 1 : 0);
  }
  [[nodiscard]] std::vector<RankedView> take() { return std::move(views_); }

 private:
  std::size_t places_;
  std::span<const Pose> poses_;
  std::vector<RankedView> views_;
};

Result<BestViews> evaluate_all(const TsdfSnapshot& map, const Region& region, std::span<const Pose> T_world_camera,
                               std::size_t count, const GainConfig& config, const Executor& executor) {
  SACCADE_TRY(const GainResult all, evaluate_views(map, region, T_world_camera, config, executor));
  BestViews best;
  best.views = order_views(all.gains, T_world_camera);
  best.views.resize(std::min(count, best.views.size()));
  best.poses_evaluated = T_world_camera.size();
  best.rays_cast = all.rays_cast;
  best.prepare_ms = all.prepare_ms;
  best.evaluate_ms = all.evaluate_ms;
  return best;
}

}  // namespace

Result<BestViews> best_views(const TsdfSnapshot& map, const Region& region, std::span<const Pose> T_world_camera,
                             std::size_t count, const GainConfig& config, const Executor& executor) {
  if (count == 0) return Error{Errc::invalid_argument, "at least one view must be asked for", "view evaluation"};
  const GainSavings& savings = config.savings;
  if (config.count != GainCount::rays || !savings.tiles || !savings.empty_bricks || !savings.region_rays) {
    return evaluate_all(map, region, T_world_camera, count, config, executor);
  }
  SACCADE_TRY(const GainProblem problem, GainProblem::prepare(map, region, T_world_camera, config, executor));
  BestViews best;
  best.prepare_ms = problem.prepare_ms;
  const Stopwatch clock;
  const std::size_t jobs = problem.jobs.size();
  std::vector<GainCaster> casters;
  casters.reserve(jobs);
  for (const GainJob& job : problem.jobs) casters.emplace_back(problem.grid, job.window, problem.limits, nullptr);

  executor.parallel_for(jobs, kLookGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      casters[i].look_over(kLookOverPx);
      casters[i].judge_open_tiles();
    }
  });
  std::vector<std::size_t> order(jobs);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return casters[a].about() > casters[b].about(); });

  Podium podium{count, T_world_camera};
  std::vector<bool> in_a_job(T_world_camera.size());
  for (const GainJob& job : problem.jobs) {
    for (const std::size_t pose : job.poses) in_a_job[pose] = true;
  }
  for (std::size_t pose = 0; pose < T_world_camera.size(); ++pose) {
    if (!in_a_job[pose]) podium.add(pose, 0);
  }
  for (std::size_t first = 0; first < jobs;) {
    const std::size_t batch = std::min(std::max(kBatch, first), jobs - first);
    executor.parallel_for(batch, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = first + begin; i < first + end; ++i) {
        casters[order[i]].refine(podium.entry(problem.jobs[order[i]].poses.front()));
      }
    });
    for (std::size_t i = first; i < first + batch; ++i) {
      if (!casters[order[i]].decided()) continue;
      for (const std::size_t pose : problem.jobs[order[i]].poses) podium.add(pose, casters[order[i]].scored());
      best.poses_evaluated += problem.jobs[order[i]].poses.size();
    }
    first += batch;
  }
  for (const GainCaster& caster : casters) best.rays_cast += caster.rays_cast();
  best.views = podium.take();
  best.evaluate_ms = clock.elapsed_ms();
  return best;
}

}  // namespace saccade
