// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/gain.hpp"

#include <algorithm>
#include <numeric>

#include "saccade/core/seeded_random.hpp"
#include "saccade/views/internal/best_views.hpp"
#include "saccade/views/internal/check_finite.hpp"
#include "saccade/views/internal/credible_rays.hpp"
#include "saccade/views/view_device.hpp"

namespace saccade {
namespace {

constexpr std::size_t kMostLooks{128};  // views whose credit is examined thoroughly

std::vector<Pose> poses_of(std::span<const RankedView> views) {
  std::vector<Pose> poses;
  poses.reserve(views.size());
  for (const RankedView& view : views) poses.push_back(view.T_world_camera);
  return poses;
}

/// Computes one gain per pose.
Result<std::vector<double>> gains_of(Gain& gain, const PlanningContext& context, const RegionOfInterest& region,
                                     std::span<const Pose> T_world_camera) {
  SACCADE_TRY(std::vector<double> gains, gain.evaluate(context, region, T_world_camera));
  if (gains.size() != T_world_camera.size()) {
    return Error{Errc::size_mismatch, "a gain must return one value per pose", "gain"};
  }
  return gains;
}

/// Computes the gains of views.
Status tell_gains(Gain& gain, const PlanningContext& context, const RegionOfInterest& region,
                  std::span<RankedView> views) {
  SACCADE_TRY(const std::vector<double> gains, gains_of(gain, context, region, poses_of(views)));
  for (std::size_t i = 0; i < views.size(); ++i) views[i].gain = gains[i];
  return {};
}

/// Reduces a gain to a share. Infinite and negative gains are not promises.
double discounted(double gain, double share) {
  if (!(gain > 0.0)) return gain;
  return share > 0.0 ? share * gain : 0.0;
}

/// Returns the poses of the most credible rays, `count` at most. O(poses · rays).
std::vector<Pose> most_credible(std::vector<Pose> poses, const CredibleRays& rays, std::size_t count,
                                const Executor& executor) {
  if (poses.size() <= count) return poses;
  std::vector<RankedView> views;
  const std::vector<CredibleRays::Glance> glances = rays.glances(poses, executor);
  for (std::size_t i = 0; i < poses.size(); ++i) views.push_back({poses[i], glances[i].credible});
  order_by_gain(views);
  views.resize(count);
  return poses_of(views);
}

RankedViews in_order(std::span<const Pose> T_world_camera, std::span<const double> gains) {
  RankedViews ranked;
  for (std::size_t i = 0; i < gains.size(); ++i) ranked.views.push_back({T_world_camera[i], gains[i]});
  ranked.evaluated = ranked.views.size();
  order_by_gain(ranked.views);
  return ranked;
}

/// Returns all poses by decreasing gain.
Result<RankedViews> by_evaluation(Gain& gain, const PlanningContext& context, const RegionOfInterest& region,
                                  std::span<const Pose> T_world_camera) {
  SACCADE_TRY(const std::vector<double> gains, gains_of(gain, context, region, T_world_camera));
  return in_order(T_world_camera, gains);
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
  SACCADE_TRY(RankedViews ranked, by_evaluation(*this, context, region, T_world_camera));
  if (!context.sensor || !CredibleRays::can_look_through(context.map)) return ranked;
  SACCADE_TRY(const CredibleRays rays,
              CredibleRays::create(context, region, *context.sensor, UnknownOutside::blocks, Trust::credible));
  const std::vector<Pose> poses = poses_of(ranked.views);
  const std::vector<CredibleRays::Glance> glances = rays.glances(poses, context.executor);
  std::vector<RankedView> glanced = ranked.views;
  for (std::size_t i = 0; i < glanced.size(); ++i) glanced[i].gain = discounted(glanced[i].gain, glances[i].credit);
  // Looks thoroughly at the views that seem best.
  std::vector<std::size_t> order(glanced.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return glanced[a].gain > glanced[b].gain; });
  order.resize(std::min(order.size(), kMostLooks));
  std::vector<Pose> best;
  for (const std::size_t i : order) best.push_back(poses[i]);
  const std::vector<CredibleRays::Look> looks = rays.looks(best, context.executor);
  for (std::size_t i = 0; i < order.size(); ++i) {
    glanced[order[i]].gain = discounted(ranked.views[order[i]].gain, looks[i].credit);
  }
  ranked.views = std::move(glanced);
  order_by_gain(ranked.views);
  ranked.promise = [rays](const Pose& pose) { return rays.from(pose).promise; };
  return ranked;
}

std::optional<std::vector<double>> RayGain::on_device(const PlanningContext& context, const RegionOfInterest& region,
                                                      std::span<const Pose> T_world_camera) const {
  if (context.device == nullptr) return std::nullopt;
  const Result<GainResult> result =
      context.device->evaluate_views_of(context.map, region.bounds, T_world_camera, config_, context.executor);
  if (!result.ok()) return std::nullopt;
  return std::vector<double>(result->gains.begin(), result->gains.end());
}

Result<std::vector<double>> RayGain::evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                              std::span<const Pose> T_world_camera) {
  if (auto gains = on_device(context, region, T_world_camera)) return *std::move(gains);
  SACCADE_TRY(const GainResult result,
              evaluate_views(context.map, region.bounds, T_world_camera, config_, context.executor));
  return std::vector<double>(result.gains.begin(), result.gains.end());
}

/// Returns the best `count` that were not attempted, and those that were.
Result<RankedViews> RayGain::by_rays(const PlanningContext& context, const RegionOfInterest& region,
                                     std::span<const Pose> T_world_camera, std::size_t count) {
  if (count >= T_world_camera.size()) return by_evaluation(*this, context, region, T_world_camera);
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
  std::vector<RankedView> views;
  if (const auto gains = on_device(context, region, others)) {
    views = in_order(others, *gains).views;
    views.resize(std::min(count, views.size()));
  } else {
    SACCADE_TRY(const BestViews best, best_views(context.map, region.bounds, others, count, config_, context.executor));
    for (const OrderedView& view : best.views) views.push_back({view.T_world_camera, static_cast<double>(view.gain)});
  }
  ranked.complete = views.size() == others.size();
  ranked.views.insert(ranked.views.begin(), views.begin(), views.end());
  order_by_gain(ranked.views);
  return ranked;
}

Result<RankedViews> RayGain::best(const PlanningContext& context, const RegionOfInterest& region,
                                  std::span<const Pose> T_world_camera, std::size_t count) {
  SACCADE_CHECK(check_finite(T_world_camera, "view gain"));
  if (!CredibleRays::can_look_through(context.map)) return by_rays(context, region, T_world_camera, count);
  SACCADE_TRY(const CredibleRays rays,
              CredibleRays::create(context, region, widened_vertically(config_.sensor, config_.tilt_rad),
                                   config_.unknown_outside, trust_));
  const auto promise = [rays](const Pose& pose) { return rays.from(pose).promise; };
  if (trust_ == Trust::blind) {
    SACCADE_TRY(RankedViews ranked, by_rays(context, region, T_world_camera, count));
    ranked.promise = promise;
    return ranked;
  }
  std::vector<Pose> attempted;
  std::vector<Pose> others;
  for (const Pose& pose : T_world_camera) (context.was_attempted(pose) ? attempted : others).push_back(pose);
  std::vector<Pose> poses = most_credible(others, rays, std::min(count, kMostLooks), context.executor);
  const bool complete = poses.size() == others.size();
  poses.insert(poses.end(), attempted.begin(), attempted.end());
  SACCADE_TRY(RankedViews ranked, by_evaluation(*this, context, region, poses));
  const std::vector<CredibleRays::Look> looks = rays.looks(poses_of(ranked.views), context.executor);
  for (std::size_t i = 0; i < looks.size(); ++i) {
    ranked.views[i].gain = discounted(ranked.views[i].gain, looks[i].share);
  }
  order_by_gain(ranked.views);
  ranked.evaluated = T_world_camera.size();
  ranked.complete = complete;
  ranked.promise = promise;
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
  if (!context.sensor || !CredibleRays::can_look_through(context.map)) return ranked;
  SACCADE_TRY(const CredibleRays rays,
              CredibleRays::create(context, region, *context.sensor, UnknownOutside::blocks, Trust::blind));
  ranked.promise = [rays](const Pose& pose) { return rays.from(pose).promise; };
  return ranked;
}

}  // namespace saccade
