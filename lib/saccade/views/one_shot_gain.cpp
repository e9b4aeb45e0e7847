// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/one_shot_gain.hpp"

#include <algorithm>
#include <limits>

#include "saccade/views/view_set.hpp"

namespace saccade {

Status OneShotGain::plan(const PlanningContext& context, const RegionOfInterest& region,
                         std::span<const Pose> T_world_camera) {
  SACCADE_TRY(RankedViews ranked, inner_->best(context, region, T_world_camera, config_.considered));
  std::vector<RankedView>& views = ranked.views;
  if (views.size() > config_.considered) views.resize(config_.considered);
  if (!ranked.promise) {
    views.resize(std::min(views.size(), config_.max_views));
    plan_ = std::move(views);
    return {};
  }
  add_promising(ranked, context.executor);
  if (!plan_.empty()) add_distant(context, T_world_camera);
  return {};
}

void OneShotGain::add_promising(const RankedViews& ranked, const Executor& executor) {
  const std::vector<RankedView>& views = ranked.views;
  std::vector<Promise> promises(views.size());
  executor.parallel_for(promises.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) promises[i] = ranked.promise(views[i].T_world_camera);
  });
  std::vector<Promise> chosen;
  double before = 0.0;
  for (const std::size_t view : best_sequence(promises, config_.max_views, executor)) {
    chosen.push_back(promises[view]);
    const double together = worth_together(chosen);
    const double enough = plan_.empty() ? 0.0 : config_.least_share * plan_.front().gain;
    if (together - before < std::max(enough, config_.min_addition)) break;
    plan_.push_back({views[view].T_world_camera, together - before});
    before = together;
  }
}

void OneShotGain::add_distant(const PlanningContext& context, std::span<const Pose> T_world_camera) {
  std::vector<double> to_plan_m(T_world_camera.size(), std::numeric_limits<double>::infinity());
  const auto note = [&](const Pose& chosen) {
    for (std::size_t i = 0; i < to_plan_m.size(); ++i) {
      to_plan_m[i] = std::min(to_plan_m[i], (T_world_camera[i].translation() - chosen.translation()).norm());
    }
  };
  for (std::size_t i = 0; i < to_plan_m.size(); ++i) {
    if (context.was_attempted(T_world_camera[i])) note(T_world_camera[i]);
  }
  for (const RankedView& view : plan_) note(view.T_world_camera);
  while (plan_.size() < config_.max_views) {
    const auto farthest = std::max_element(to_plan_m.begin(), to_plan_m.end());
    if (!(*farthest > 0.0)) return;
    plan_.push_back({T_world_camera[static_cast<std::size_t>(farthest - to_plan_m.begin())], config_.min_addition});
    note(plan_.back().T_world_camera);
  }
}

Result<RankedViews> OneShotGain::best(const PlanningContext& context, const RegionOfInterest& region,
                                      std::span<const Pose> T_world_camera, std::size_t /*count*/) {
  if (!planned_) {
    SACCADE_CHECK(plan(context, region, T_world_camera));
    planned_ = true;
  }
  RankedViews left;
  left.by_gain = false;
  left.evaluated = T_world_camera.size();
  for (const RankedView& view : plan_) {
    if (!context.was_attempted(view.T_world_camera)) left.views.push_back(view);
  }
  return left;
}

}  // namespace saccade
