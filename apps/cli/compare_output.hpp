// SPDX-License-Identifier: Apache-2.0
#pragma once
// What `saccade compare` makes of finished runs: CSV tables, curves, a summary for people and one for machines.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "saccade/io/campaign_summary.hpp"

namespace saccade::cli {

/// Two strategies in one scene.
struct StrategyGap {
  std::string scene;
  std::string a;
  std::string b;
  MeanEstimate coverage;   ///< final coverage of a minus that of b, in the seeds that both have
  bool apart_initially{};  ///< the intervals of the two means do not touch, after the initial scan
  bool apart{};            ///< and at the end
};

/// The first strategy of each scene against each other one.
[[nodiscard]] std::vector<StrategyGap> gaps_of(std::span<const CampaignRun> runs,
                                               std::span<const CampaignSummary> summaries);

/// "coverage-SCENE.svg", where what is neither a letter nor a digit of ASCII, nor one of "._-", becomes a hyphen.
[[nodiscard]] std::string picture_name(const std::string& scene);

/// Writes runs.csv, views.csv, summary.csv and a picture per scene into the folder. io_failure.
[[nodiscard]] Status write_comparison(const std::filesystem::path& folder, std::span<const CampaignRun> runs,
                                      std::span<const CampaignSummary> summaries);

void print_comparison(std::ostream& out, std::span<const CampaignSummary> summaries, std::span<const StrategyGap> gaps);

/// {summaries: […], gaps: […]}.
[[nodiscard]] nlohmann::json comparison_json(std::span<const CampaignSummary> summaries,
                                             std::span<const StrategyGap> gaps);

}  // namespace saccade::cli
