// SPDX-License-Identifier: Apache-2.0
#pragma once
// ViewPlanner: where to look next. Thesis §3.1, Algorithm 4; with given regions NextBestView of Algorithm 1, line 5.

#include <memory>

#include "saccade/attention/attention_source.hpp"
#include "saccade/explore/ranking.hpp"
#include "saccade/views/gain.hpp"
#include "saccade/views/view_generator.hpp"

namespace saccade {

struct ViewPlannerConfig {
  /// IncTh of Algorithm 1, ScoreTH of Algorithm 4, in the unit of the gain: a region whose best view gains less is
  /// done.
  double min_gain{200.0};
  /// Among regions at least so salient, as a share of the most salient that has a view worth trying, the view that
  /// gains most is next. Thesis Algorithm 4 takes the most salient region alone: 1. Decision 11.
  double rival_share{0.5};
  std::size_t tries{16};  ///< views of a region that are ranked at a time; more once these were tried
  std::size_t views_per_region{std::numeric_limits<std::size_t>::max()};  ///< after which a region is left
  /// Views that the robot cannot take are left out before gains are evaluated. false: they are evaluated, too, and
  /// skipped once they are tried (Algorithm 1, lines 5 to 10).
  bool asks_robot_first{true};

  [[nodiscard]] Status validate() const;
};

/// What a planner is made of.
struct PlannerParts {
  std::shared_ptr<AttentionSource> attention;
  std::shared_ptr<ViewGenerator> generator;
  std::shared_ptr<Gain> gain;
  ViewPlannerConfig config{};
};

/// One caller at a time. Follows the map from call to call; what it ranks depends on the scene alone, so that a run can
/// be resumed.
class ViewPlanner {
 public:
  explicit ViewPlanner(PlannerParts parts) : parts_{std::move(parts)} {}
  /// The parts outlive the planner.
  ViewPlanner(AttentionSource& attention, ViewGenerator& generator, Gain& gain, const ViewPlannerConfig& config = {});

  /// Views of the most salient region that has one worth trying, or of a rival whose best view gains more.
  /// @return an empty ranking when no view is worth trying; errors of the parts.
  [[nodiscard]] Result<Ranking> rank(const PlanningScene& scene);

  /// The same planner with other regions, which outlive it.
  [[nodiscard]] ViewPlanner with(AttentionSource& attention) const;
  [[nodiscard]] const ViewPlannerConfig& config() const { return parts_.config; }

 private:
  PlannerParts parts_;
};

}  // namespace saccade
