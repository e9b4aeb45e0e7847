// SPDX-License-Identifier: Apache-2.0
#pragma once
// Output of `saccade compare` for finished runs: CSV tables, curves, a summary for people and one for machines.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/report/plot.hpp"
#include "saccade/trial/campaign_summary.hpp"

namespace saccade::cli {

/// Two strategies in one scene, or in all, with one noise.
struct StrategyGap {
  CampaignGroup a;
  CampaignGroup b;
  std::vector<MeanEstimate> figures;  ///< paired_gaps
  bool apart_initially{};             ///< the intervals of the mean coverages do not touch, after the initial scan
  bool apart{};                       ///< and at the end

  /// Expects the name of a figure.
  [[nodiscard]] const MeanEstimate& of(std::string_view name) const { return figures[run_figure_index(name)]; }
};

/// A comparison that is done, or as far as it is.
struct ComparedRuns {
  std::vector<CampaignEntry> runs;
  std::size_t budget{0};  ///< views that every run might have taken
  std::vector<CampaignSummary> summaries;
  std::vector<StrategyGap> gaps;  ///< the first strategy of each scene and noise against each other one
};
[[nodiscard]] ComparedRuns compared(std::vector<CampaignEntry> runs, std::size_t budget);

/// "sphere", or "sphere, none" where several noises are compared.
[[nodiscard]] std::string label_of(const CampaignGroup& group, const ComparedRuns& compared);

/// "sphere - random", or "sphere - random, none", with whatever stands for the minus.
[[nodiscard]] std::string gap_label(const StrategyGap& gap, const ComparedRuns& compared, const std::string& minus);

/// Mean and confidence band over the views, a curve per strategy and noise of the scene; nullopt: all scenes.
[[nodiscard]] Plot coverage_plot(const ComparedRuns& compared, const std::optional<std::string>& scene);
/// As coverage_plot, for the unknown voxels near the objects (Fig. 3.17).
[[nodiscard]] Plot unknown_plot(const ComparedRuns& compared, const std::optional<std::string>& scene);

/// "coverage-SCENE.svg", where what is neither a letter nor a digit of ASCII, nor one of "._-", becomes a hyphen.
[[nodiscard]] std::string picture_name(const std::string& what, const std::string& scene);

/// Writes runs.csv, views.csv, summary.csv and two pictures per scene into the folder. io_failure.
[[nodiscard]] Status write_comparison(const std::filesystem::path& folder, const ComparedRuns& compared,
                                      const Executor& executor);

/// "50 views kept 97 % of what they promised (median); rank correlation 0.94; 1 kept less than a tenth". Expects a
/// view.
[[nodiscard]] std::string calibration_text(const Calibration& calibration);

void print_comparison(std::ostream& out, const ComparedRuns& compared);

/// {n, mean, low, high}; null where there is no value or no interval.
[[nodiscard]] nlohmann::json estimate_json(const MeanEstimate& estimate);

/// {summaries: […], gaps: […]}.
[[nodiscard]] nlohmann::json comparison_json(const ComparedRuns& compared);

/// Returns the figure as people read it: "93.1 ± 0.8", without its unit, and without a half width where there is none.
/// Appends "(7 of 10)" where only 7 of 10 runs have the figure. Returns an empty text where no run has it.
[[nodiscard]] std::string estimate_text(const RunFigure& figure, const MeanEstimate& estimate, std::size_t of);

}  // namespace saccade::cli
