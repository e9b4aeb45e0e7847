// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the runs of a campaign say together: their figures, means with confidence intervals, curves over views, paired
// differences, CSV tables. Definitions: docs/metrics.md, columns: docs/compare.md.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/statistics.hpp"
#include "saccade/io/files/csv.hpp"
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

/// Runs that differ in their seed alone; or, without a scene, the same in all scenes: then each scene counts once, with
/// the mean of its runs, since seeds of one scene are no independent samples of scenes.
struct CampaignGroup {
  std::optional<std::string> scene;
  std::string strategy;
  std::string noise;

  [[nodiscard]] bool operator==(const CampaignGroup&) const = default;
};

/// Views that keep less than this share of their promise broke it.
constexpr double kBrokenShare{0.1};

/// How far views keep what gains promise, over all views whose promise was checked.
struct Calibration {
  std::size_t views{0};
  std::optional<double> rank_correlation;  ///< promised beside observed gain; see rank_correlation()
  std::optional<double> median_kept;       ///< observed gain as a share of the promised one
  std::size_t broken{0};                   ///< views that kept less than kBrokenShare
};
[[nodiscard]] Calibration calibration_of(std::span<const ViewRecord* const> views);

struct CampaignSummary {
  CampaignGroup group;
  std::size_t runs{0};
  std::vector<MeanEstimate> figures;           ///< as run_figures(), each over the runs that have it
  std::map<std::string, std::size_t> stopped;  ///< runs by why they stopped
  Calibration calibration;                     ///< over all views of all runs

  /// Expects the name of a figure.
  [[nodiscard]] const MeanEstimate& of(std::string_view name) const { return figures[run_figure_index(name)]; }
};

/// One summary per group, in the order in which they first occur; those over all scenes follow where there are several.
/// Runs with other settings are not told apart: give it the runs of one comparison.
/// @param budget views that every run might have taken
[[nodiscard]] std::vector<CampaignSummary> summarize(std::span<const CampaignEntry> runs, std::size_t budget);

/// A figure of the map.
using MapFigure = double (*)(const Measures& map);

/// The mean of it after 0, 1, …, `budget` views. A run that ended earlier counts on with its last map, which stays as
/// it is. Empty without runs.
[[nodiscard]] std::vector<MeanEstimate> over_views(std::span<const CampaignEntry> runs, const CampaignGroup& group,
                                                   std::size_t budget, MapFigure figure);

/// Views k = 1, …, kFirstViews: share of the group's runs whose k-th view points at an object, of those that took it.
[[nodiscard]] std::vector<MeanEstimate> object_view_shares(std::span<const CampaignEntry> runs,
                                                           const CampaignGroup& group);

/// run_figures() of `a` minus those of `b` in each seed of a scene that both have, as means. What a seed does to both
/// cancels out, so that this tells more than two intervals side by side. Expects groups of one scene, or of all.
[[nodiscard]] std::vector<MeanEstimate> paired_gaps(std::span<const CampaignEntry> runs, const CampaignGroup& a,
                                                    const CampaignGroup& b, std::size_t budget);

/// A row per run: its key, why it stopped, and run_figures().
[[nodiscard]] CsvTable runs_csv(std::span<const CampaignEntry> runs, std::size_t budget);
/// A row per view, and one with number 0 for the initial scan of each run.
[[nodiscard]] CsvTable views_csv(std::span<const CampaignEntry> runs);
/// A row per group and figure: how many runs (or scenes) have it, mean, low and high end. The scene of a group over all
/// scenes is empty.
[[nodiscard]] CsvTable summary_csv(std::span<const CampaignSummary> summaries);

}  // namespace saccade
