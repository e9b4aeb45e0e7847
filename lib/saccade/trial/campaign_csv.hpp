// SPDX-License-Identifier: Apache-2.0
#pragma once
// Runs of a campaign as CSV tables. Columns: docs/compare.md.

#include "saccade/io/files/csv.hpp"
#include "saccade/trial/campaign_summary.hpp"

namespace saccade {

/// A row per run: its key, why it stopped, and run_figures().
[[nodiscard]] CsvTable runs_csv(std::span<const CampaignEntry> runs, std::size_t budget);
/// A row per view, and one with number 0 for the initial scan of each run.
[[nodiscard]] CsvTable views_csv(std::span<const CampaignEntry> runs);
/// A row per group and figure: how many runs (or scenes) have it, mean, low and high end. The scene of a group over all
/// scenes is empty.
[[nodiscard]] CsvTable summary_csv(std::span<const CampaignSummary> summaries);

}  // namespace saccade
