// SPDX-License-Identifier: Apache-2.0
#pragma once
// OneShotGain: all views of a run, chosen at once from what the first look promises.

#include <memory>

#include "saccade/views/gain.hpp"

namespace saccade {

struct OneShotConfig {
  std::size_t max_views{12};    ///< length of the plan
  std::size_t considered{512};  ///< candidates with the largest gain that the plan is chosen from
  /// A view that adds less than this share of the first one's promise to those before it is not chosen by what it adds.
  double least_share{0.1};
  double min_addition{1e-9};  ///< the same, in the unit of the gain; also the gain of views that are not chosen by it
};

/// Plans once: of the candidates' promises, the sequence that makes most known (best_sequence), the greedy solution of
/// the set covering that one-shot planners predict. The first look promises nothing of what it cannot guess, so once
/// little is added, the views farthest from those of the plan follow (decision 0044). Later calls return what is left
/// of the plan, whatever was seen since. Unlike other gains it keeps its plan from call to call, so a run with it
/// cannot be resumed in between.
class OneShotGain final : public Gain {
 public:
  /// @param inner  gain that makes promises; without promises the plan has the views of largest gain.
  OneShotGain(std::shared_ptr<Gain> inner, const OneShotConfig& config) : inner_{std::move(inner)}, config_{config} {}
  [[nodiscard]] Result<std::vector<double>> evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> T_world_camera) override {
    return inner_->evaluate(context, region, T_world_camera);
  }
  /// Returns the plan without the views that were attempted, in its order. Each has as its gain what it adds to those
  /// before it. Errors: those of the inner gain.
  [[nodiscard]] Result<RankedViews> best(const PlanningContext& context, const RegionOfInterest& region,
                                         std::span<const Pose> T_world_camera, std::size_t count) override;

 private:
  [[nodiscard]] Status plan(const PlanningContext& context, const RegionOfInterest& region,
                            std::span<const Pose> T_world_camera);
  /// Adds the views that add enough to those before them.
  void add_promising(const RankedViews& ranked, const Executor& executor);
  /// Adds the view whose camera is farthest from those of the plan, until the plan is full.
  void add_distant(const PlanningContext& context, std::span<const Pose> T_world_camera);

  std::shared_ptr<Gain> inner_;
  OneShotConfig config_;
  bool planned_{false};
  std::vector<RankedView> plan_;
};

}  // namespace saccade
