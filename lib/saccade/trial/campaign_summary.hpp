// SPDX-License-Identifier: Apache-2.0
#pragma once
// Statistics over the runs of a campaign: their measures, means with confidence intervals, curves over views, paired
// differences, CSV tables. Definitions: docs/reference/metrics.md, columns: docs/guides/compare.md.

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

/// Number of views in Table 3.3 and Fig. 3.17 of the thesis.
constexpr std::size_t kFirstViews{5};

/// Returns the measures after `taken` views, or the last ones of a run that ended earlier.
[[nodiscard]] const Measures& figures_after(const CampaignEntry& run, std::size_t taken);

/// Returns the number of views after which the coverage is at least `share`; 0: already after the scan; nullopt: never.
[[nodiscard]] std::optional<std::size_t> views_to_coverage(const CampaignEntry& run, double share);

/// Returns the mean coverage after 0, 1, …, `budget` views.
[[nodiscard]] double coverage_area(const CampaignEntry& run, std::size_t budget);

/// Counts, among the first kFirstViews views, those that point at an object.
[[nodiscard]] std::size_t object_views(const CampaignEntry& run);

/// Tells whether, among these, all views that point at an object come before all others. nullopt where none does.
[[nodiscard]] std::optional<bool> objects_come_first(const CampaignEntry& run);

/// Measure of a run. For people, a value is shown times `scale`, with `decimals` decimals and the unit.
struct RunFigure {
  std::string name;  ///< name in tables and JSON
  std::string text;  ///< for people
  std::string_view unit;
  double scale{1.0};
  int decimals{0};
  /// Computes the measure; nullopt where the run lacks it. @param budget views that every run might have taken
  std::function<std::optional<double>(const CampaignEntry& run, std::size_t budget)> of;
};

/// Returns all measures of runs, in the order of the tables.
[[nodiscard]] std::span<const RunFigure> run_figures();
/// Returns a position in run_figures(). Expects a valid name.
[[nodiscard]] std::size_t run_figure_index(std::string_view name);

/// Group of runs that differ only in their seed; or, without a scene, such runs in all scenes. Then each scene counts
/// once, with the mean of its runs, since seeds of one scene are not independent samples of scenes.
struct CampaignGroup {
  std::optional<std::string> scene;
  std::string strategy;
  std::string noise;

  [[nodiscard]] bool operator==(const CampaignGroup&) const = default;
};

/// Views that keep a smaller share of their promise broke it.
constexpr double kBrokenShare{0.1};

/// Agreement of observed with promised gains, over all views whose promise was checked.
struct Calibration {
  std::size_t views{0};
  std::optional<double> rank_correlation;  ///< correlation of promised and observed gain; see rank_correlation()
  std::optional<double> median_kept;       ///< observed relative to promised gain
  std::size_t broken{0};                   ///< views that kept less than kBrokenShare
};
[[nodiscard]] Calibration calibration_of(std::span<const ViewRecord* const> views);

struct CampaignSummary {
  CampaignGroup group;
  std::size_t runs{0};
  std::vector<MeanEstimate> figures;           ///< in the order of run_figures(), each over the runs that have it
  std::map<std::string, std::size_t> stopped;  ///< number of runs by stop reason
  Calibration calibration;                     ///< over all views of all runs

  /// Expects the name of a measure.
  [[nodiscard]] const MeanEstimate& of(std::string_view name) const { return figures[run_figure_index(name)]; }
};

/// Returns one summary per group, in the order of first occurrence; those over all scenes follow where there are
/// several. Settings are not distinguished, so pass the runs of one comparison.
/// @param budget views that every run might have taken
[[nodiscard]] std::vector<CampaignSummary> summarize(std::span<const CampaignEntry> runs, std::size_t budget);

/// Measure of the map.
using MapFigure = double (*)(const Measures& map);

/// Returns the mean of a measure after 0, 1, …, `budget` views. A run that ended earlier contributes its last map.
/// Empty without runs.
[[nodiscard]] std::vector<MeanEstimate> over_views(std::span<const CampaignEntry> runs, const CampaignGroup& group,
                                                   std::size_t budget, MapFigure figure);

/// Returns for views k = 1, …, kFirstViews the share of the group's runs whose k-th view points at an object, among
/// those that took it.
[[nodiscard]] std::vector<MeanEstimate> object_view_shares(std::span<const CampaignEntry> runs,
                                                           const CampaignGroup& group);

/// Returns the means of run_figures() of `a` minus those of `b`, over the seeds of a scene that both have. Effects of a
/// seed on both cancel out, so this is sharper than comparing two intervals. Expects groups of one scene, or of all.
[[nodiscard]] std::vector<MeanEstimate> paired_gaps(std::span<const CampaignEntry> runs, const CampaignGroup& a,
                                                    const CampaignGroup& b, std::size_t budget);

/// Writes one row per run: its key, stop reason, and run_figures(). Atomic, as CsvTable::write.
[[nodiscard]] Status write_runs_csv(const std::filesystem::path& path, std::span<const CampaignEntry> runs,
                                    std::size_t budget);
/// Writes one row per view, and one with number 0 for the initial scan of each run. Atomic, as CsvTable::write.
[[nodiscard]] Status write_views_csv(const std::filesystem::path& path, std::span<const CampaignEntry> runs);
/// Returns one row per group and measure: number of runs (or scenes) with it, mean, low and high end. The scene of a
/// group over all scenes is empty.
[[nodiscard]] CsvTable summary_csv(std::span<const CampaignSummary> summaries);

}  // namespace saccade
