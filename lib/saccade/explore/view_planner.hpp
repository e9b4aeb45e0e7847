// SPDX-License-Identifier: Apache-2.0
#pragma once
// ViewPlanner: chooses the next views. Thesis §3.1, Algorithm 4; with given regions NextBestView of Algorithm 1, line
// 5.

#include <memory>

#include "saccade/attention/attention_source.hpp"
#include "saccade/explore/ranking.hpp"
#include "saccade/views/gain.hpp"
#include "saccade/views/view_generator.hpp"

namespace saccade {

struct ViewPlannerConfig {
  /// IncTh of Algorithm 1, ScoreTH of Algorithm 4, in the unit of the gain: a region whose best view gains less is
  /// done. Finite, 0 or more.
  double min_gain{200.0};
  /// Smallest saliency of rival regions, relative to the most salient region with a view worth trying. The view with
  /// the largest gain among these regions is next. Thesis Algorithm 4 takes the most salient region alone: 1. Decision
  /// 11.
  double rival_share{0.5};
  std::size_t tries{16};  ///< views of a region ranked at a time; more after these were tried
  std::size_t views_per_region{std::numeric_limits<std::size_t>::max()};  ///< limit after which a region is left
  /// Whether unreachable views are dropped before gains are evaluated. false: they are evaluated too, and skipped when
  /// tried (Algorithm 1, lines 5 to 10).
  bool asks_robot_first{true};

  [[nodiscard]] Status validate() const;
};

/// Parts of a planner.
struct PlannerParts {
  std::shared_ptr<AttentionSource> attention;
  std::shared_ptr<ViewGenerator> generator;
  std::shared_ptr<Gain> gain;
  ViewPlannerConfig config{};
};

/// Planner of views. One caller at a time. Follows the map from call to call; its ranking depends on the scene alone,
/// so that a run can be resumed.
class ViewPlanner {
 public:
  explicit ViewPlanner(PlannerParts parts) : parts_{std::move(parts)} {}
  /// The parts must outlive the planner.
  ViewPlanner(AttentionSource& attention, ViewGenerator& generator, Gain& gain, const ViewPlannerConfig& config = {});

  /// Ranks the views of the most salient region that has one worth trying, or of a rival whose best view gains more.
  /// @return an empty ranking when no view is worth trying; errors of the parts.
  [[nodiscard]] Result<Ranking> rank(const PlanningScene& scene);

  /// Returns this planner with other regions, which must outlive it.
  [[nodiscard]] ViewPlanner with(AttentionSource& attention) const;
  [[nodiscard]] const ViewPlannerConfig& config() const { return parts_.config; }

 private:
  PlannerParts parts_;
};

}  // namespace saccade
