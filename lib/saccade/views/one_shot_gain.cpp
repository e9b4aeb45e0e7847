// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/one_shot_gain.hpp"

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
  std::vector<Promise> promises(views.size());
  context.executor.parallel_for(promises.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) promises[i] = ranked.promise(views[i].T_world_camera);
  });
  std::vector<Promise> chosen;
  double before = 0.0;
  for (const std::size_t view : best_sequence(promises, config_.max_views, context.executor)) {
    chosen.push_back(promises[view]);
    const double together = worth_together(chosen);
    if (together - before < config_.min_addition) break;
    plan_.push_back({views[view].T_world_camera, together - before});
    before = together;
  }
  return {};
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
