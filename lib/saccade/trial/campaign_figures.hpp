// SPDX-License-Identifier: Apache-2.0
#pragma once
// RunFigure: the numbers that a run of a campaign comes to. Definitions: docs/metrics.md.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "saccade/trial/campaign.hpp"

namespace saccade {

/// Views that Table 3.3 and Fig. 3.17 of the thesis look at.
constexpr std::size_t kFirstViews{5};

/// The map after `taken` views; of a run that ended earlier, as it was left.
[[nodiscard]] const Measures& figures_after(const CampaignEntry& run, std::size_t taken);

/// Views after which the coverage is at least `share`, 0: after the scan already; nullopt: never.
[[nodiscard]] std::optional<std::size_t> views_to_coverage(const CampaignEntry& run, double share);

/// Mean coverage after 0, 1, …, `budget` views.
[[nodiscard]] double coverage_area(const CampaignEntry& run, std::size_t budget);

/// Of the first kFirstViews views, those that point at an object.
[[nodiscard]] std::size_t object_views(const CampaignEntry& run);

/// Whether, of these, each that points at an object comes before each that does not. nullopt without views.
[[nodiscard]] std::optional<bool> objects_come_first(const CampaignEntry& run);

/// For people: a value is shown times `scale`, with so many decimals and the unit.
struct RunFigure {
  std::string name;  ///< in tables and JSON
  std::string text;  ///< for people
  std::string_view unit;
  double scale{1.0};
  int decimals{0};
  /// nullopt where the run does not have it. @param budget views that every run might have taken
  std::function<std::optional<double>(const CampaignEntry& run, std::size_t budget)> of;
};

/// All of them, in the order of the tables.
[[nodiscard]] std::span<const RunFigure> run_figures();
/// Position in run_figures(). Expects a name of one.
[[nodiscard]] std::size_t run_figure_index(std::string_view name);

}  // namespace saccade
