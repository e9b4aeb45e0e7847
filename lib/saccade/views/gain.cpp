// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/gain.hpp"

#include <algorithm>

#include "saccade/core/seeded_random.hpp"
#include "saccade/views/internal/best_views.hpp"

namespace saccade {
namespace {

std::vector<Pose> poses_of(std::span<const RankedView> views) {
  std::vector<Pose> poses;
  poses.reserve(views.size());
  for (const RankedView& view : views) poses.push_back(view.T_world_camera);
  return poses;
}

/// Fills in the gains of the first views.
Status tell_gains(Gain& gain, const PlanningContext& context, const RegionOfInterest& region,
                  std::span<RankedView> views) {
  const std::vector<Pose> poses = poses_of(views);
  SACCADE_TRY(const std::vector<double> gains, gain.evaluate(context, region, poses));
  if (gains.size() != poses.size()) {
    return Error{Errc::size_mismatch, "a gain must return one value per pose", "gain"};
  }
  for (std::size_t i = 0; i < views.size(); ++i) views[i].gain = gains[i];
  return {};
}

}  // namespace

std::vector<std::size_t> starts_of_centers(std::span<const Pose> T_world_camera) {
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < T_world_camera.size(); ++i) {
    if (i == 0 || T_world_camera[i].translation() != T_world_camera[i - 1].translation()) starts.push_back(i);
  }
  starts.push_back(T_world_camera.size());
  return starts;
}

void order_by_gain(std::span<RankedView> views) {
  std::stable_sort(views.begin(), views.end(),
                   [](const RankedView& a, const RankedView& b) { return a.gain > b.gain; });
}

Result<RankedViews> Gain::best(const PlanningContext& context, const RegionOfInterest& region,
                               std::span<const Pose> T_world_camera, std::size_t /*count*/) {
  RankedViews ranked;
  for (const Pose& pose : T_world_camera) ranked.views.push_back({pose});
  SACCADE_CHECK(tell_gains(*this, context, region, ranked.views));
  ranked.evaluated = ranked.views.size();
  order_by_gain(ranked.views);
  return ranked;
}

Result<std::vector<double>> RayGain::evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                              std::span<const Pose> T_world_camera) {
  SACCADE_TRY(const GainResult result,
              evaluate_views(context.map, region.bounds, T_world_camera, config_, context.executor));
  return std::vector<double>(result.gains.begin(), result.gains.end());
}

Result<RankedViews> RayGain::best(const PlanningContext& context, const RegionOfInterest& region,
                                  std::span<const Pose> T_world_camera, std::size_t count) {
  if (count >= T_world_camera.size()) return Gain::best(context, region, T_world_camera, count);
  RankedViews ranked;
  std::vector<Pose> others;
  for (const Pose& pose : T_world_camera) {
    if (context.was_attempted(pose)) {
      ranked.views.push_back({pose});
    } else {
      others.push_back(pose);
    }
  }
  ranked.evaluated = T_world_camera.size();
  if (!ranked.views.empty()) SACCADE_CHECK(tell_gains(*this, context, region, ranked.views));
  if (others.empty()) return ranked;
  SACCADE_TRY(const BestViews best, best_views(context.map, region.bounds, others, count, config_, context.executor));
  ranked.complete = best.views.size() == others.size();
  std::vector<RankedView> views;
  for (const OrderedView& view : best.views) views.push_back({view.T_world_camera, static_cast<double>(view.gain)});
  ranked.views.insert(ranked.views.begin(), views.begin(), views.end());
  order_by_gain(ranked.views);
  return ranked;
}

Result<std::vector<double>> RandomOrder::evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                  std::span<const Pose> T_world_camera) {
  return told_->evaluate(context, region, T_world_camera);
}

Result<RankedViews> RandomOrder::best(const PlanningContext& context, const RegionOfInterest& region,
                                      std::span<const Pose> T_world_camera, std::size_t count) {
  constexpr std::uint64_t kViewStride{1'000'003};
  RankedViews ranked;
  ranked.by_gain = false;
  for (const Pose& pose : T_world_camera) ranked.views.push_back({pose});
  SeededRandom{config_.seed + context.region + (config_.anew ? kViewStride * context.views_taken : 0)}.shuffle(
      ranked.views);
  std::size_t next = std::min(ranked.views.size(), context.views_taken + count);
  if (config_.anew) {
    std::erase_if(ranked.views, [&](const RankedView& view) { return context.was_attempted(view.T_world_camera); });
    ranked.complete = ranked.views.size() <= count;
    if (!ranked.complete) ranked.views.resize(count);
    next = ranked.views.size();
  }
  SACCADE_CHECK(tell_gains(*told_, context, region, std::span{ranked.views}.first(next)));
  ranked.evaluated = next;
  return ranked;
}

}  // namespace saccade
