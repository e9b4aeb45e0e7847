// SPDX-License-Identifier: Apache-2.0
#pragma once
// Planners: view planners by name, which a program can extend. PlannerSetup: settings that they are made from.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/attention/salient_objects.hpp"
#include "saccade/explore/view_planner.hpp"
#include "saccade/views/surface_gain.hpp"

namespace saccade {

class GroundTruth;

/// Settings for planners; each uses what it needs.
struct PlannerSetup {
  GainConfig gain{};  ///< the virtual sensor
  ViewSphereConfig sphere{};
  ContourConfig contours{};
  ContourViewConfig contour_views{};
  SalientObjectsConfig attention{};
  /// Whether the strategy `surface` weighs expected surface by the saliency of its segment; false: all surface counts
  /// alike.
  bool weigh_by_saliency{false};
  double least_share{SurfaceGainConfig{}.least_share};
  MakeSight sight{};  ///< lines of sight of the strategy `surface`; empty: along the voxels of the map
  /// Follows Algorithms 1 and 4 to the letter: only the most salient segment counts, scraps are ordinary segments,
  /// gains of rays are believed whatever earlier views have shown, and sphere evaluates unreachable poses too.
  bool as_printed{false};
  /// Whether the explorer weighs more than gains (Foresight, ExplorerConfig::good_enough) and needs many places to
  /// choose from.
  bool looks_ahead{false};
  ViewPlannerConfig planner{};    ///< min_gain and rival_share
  std::vector<Region> regions{};  ///< regions to take in turn
  std::size_t max_views{12};      ///< limit of the run
  std::uint64_t seed{1};
  PinholeCamera camera{};             ///< the real camera
  const GroundTruth* truth{nullptr};  ///< ground truth of a simulated run; nullptr: none
};

/// A planner by its name.
struct NamedPlanner {
  std::string name;
  std::string text;              ///< one line for people
  double min_gain{200.0};        ///< default of ViewPlannerConfig::min_gain
  bool looks_at_regions{false};  ///< takes regions in turn; false: explores the whole workspace
  bool needs_truth{false};
  std::function<PlannerParts(const PlannerSetup& setup)> make;
  std::string gain_unit{"rays"};
  bool uses_seed{true};  ///< PlannerSetup::seed changes its views
};

/// Planners of a program, in their order.
class Planners {
 public:
  /// Adds a planner, replacing one of that name.
  void add(NamedPlanner planner);
  /// Finds a planner by name. Answers invalid_argument, with the known names and the nearest of them, for
  /// any other.
  [[nodiscard]] Result<NamedPlanner> find(std::string_view name) const;
  /// Lists the names: "attention, standard, …"
  [[nodiscard]] std::string names() const;
  [[nodiscard]] const std::vector<NamedPlanner>& all() const { return planners_; }

 private:
  std::vector<NamedPlanner> planners_;
};

/// Returns the planner by expected surface in cm².
[[nodiscard]] NamedPlanner surface_planner();
/// Returns the planner by the most salient object's contours. Thesis §3.1, Algorithm 4.
[[nodiscard]] NamedPlanner attention_planner();
inline constexpr std::string_view kOneShotSuffix{"-one-shot"};
/// Returns the planner that chooses all its views at once from what the first look promises: OneShotGain over the gain
/// of `planner`, named "NAME-one-shot".
[[nodiscard]] NamedPlanner one_shot(const NamedPlanner& planner);
/// Returns the planners that need no ground truth.
[[nodiscard]] Planners builtin_planners();

}  // namespace saccade
