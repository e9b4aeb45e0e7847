// SPDX-License-Identifier: Apache-2.0
#pragma once
// Runs of a campaign as CSV tables. Columns: docs/compare.md.

#include "saccade/io/campaign_summary.hpp"
#include "saccade/io/csv.hpp"

namespace saccade {

/// A row per run.
[[nodiscard]] CsvTable runs_csv(std::span<const CampaignRun> runs);
/// A row per view, and one with number 0 for the initial scan of each run.
[[nodiscard]] CsvTable views_csv(std::span<const CampaignRun> runs);
/// A row per scene and strategy: number of runs, then mean, low and high end of each figure.
[[nodiscard]] CsvTable summary_csv(std::span<const CampaignSummary> summaries);

}  // namespace saccade
