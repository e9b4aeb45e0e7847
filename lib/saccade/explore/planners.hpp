// SPDX-License-Identifier: Apache-2.0
#pragma once
// Planners: the view planners that have a name, to which a program adds its own; PlannerSetup: what they are made from.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/attention/salient_objects.hpp"
#include "saccade/explore/view_planner.hpp"
#include "saccade/views/surface_gain.hpp"

namespace saccade {

class Truth;

/// What planners are made from; each takes what it needs.
struct PlannerSetup {
  GainConfig gain{};  ///< the virtual sensor
  ViewSphereConfig sphere{};
  ContourConfig contours{};
  ContourViewConfig contour_views{};
  SalientObjectsConfig attention{};
  /// The strategy `surface` weighs what it expects by the saliency of its segment; false: all surface counts alike.
  bool weigh_by_saliency{false};
  double least_share{SurfaceGainConfig{}.least_share};
  /// Algorithms 1 and 4 to the letter: attention heeds the most salient segment alone, scraps are like any other, gains
  /// of rays are believed whatever earlier views have shown, and sphere evaluates what the robot cannot take, too.
  bool as_printed{false};
  /// The explorer weighs more than gains (Foresight, ExplorerConfig::good_enough): it is offered many places to choose
  /// from.
  bool looks_ahead{false};
  ViewPlannerConfig planner{};    ///< min_gain and rival_share
  std::vector<Region> regions{};  ///< regions that are taken in turn
  std::size_t max_views{12};      ///< limit of the run
  std::uint64_t seed{1};
  PinholeCamera camera{};       ///< the real one
  const Truth* truth{nullptr};  ///< what a simulated run knows; nullptr: there is none
};

/// A planner by its name.
struct NamedPlanner {
  std::string name;
  std::string text;              ///< one line for people
  double min_gain{200.0};        ///< ViewPlannerConfig::min_gain unless told otherwise
  bool looks_at_regions{false};  ///< takes regions in turn; else it looks wherever in the workspace
  bool needs_truth{false};
  std::function<PlannerParts(const PlannerSetup& setup)> make;
  std::string gain_unit{"rays"};
};

/// The planners of a program, in their order.
class Planners {
 public:
  /// Replaces the one of that name, if there is one.
  void add(NamedPlanner planner);
  /// invalid_argument, with the known names, for any other.
  [[nodiscard]] Result<NamedPlanner> find(std::string_view name) const;
  /// "attention, standard, …"
  [[nodiscard]] std::string names() const;
  [[nodiscard]] const std::vector<NamedPlanner>& all() const { return planners_; }

 private:
  std::vector<NamedPlanner> planners_;
};

/// The surface that is expected to be shown, in cm².
[[nodiscard]] NamedPlanner surface_planner();
/// The most salient object's contours. Thesis §3.1, Algorithm 4.
[[nodiscard]] NamedPlanner attention_planner();
/// The table of planners that need no ground truth.
[[nodiscard]] Planners builtin_planners();

}  // namespace saccade
