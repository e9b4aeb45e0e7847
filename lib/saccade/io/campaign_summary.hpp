// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the runs of a campaign say together: means with confidence intervals, coverage over views, paired differences.

#include <span>
#include <string>
#include <vector>

#include "saccade/explore/statistics.hpp"
#include "saccade/io/campaign.hpp"

namespace saccade {

/// All runs of one scene with one strategy. Accuracy and F-score are over the runs that have them.
struct CampaignSummary {
  std::string scene;
  std::string strategy;
  MeanEstimate initial_coverage;
  MeanEstimate coverage;
  MeanEstimate unknown_near_objects;
  MeanEstimate f_score;
  MeanEstimate accuracy_m;
  MeanEstimate views;
  MeanEstimate seconds;
};

/// One summary per scene and strategy, in the order in which they first occur. Runs with other settings are not told
/// apart: give it the runs of one comparison.
[[nodiscard]] std::vector<CampaignSummary> summarize(std::span<const CampaignRun> runs);

/// Mean coverage of a scene and strategy after 0, 1, … views, up to the longest run. A run that ended earlier counts
/// on with its last coverage: its map stays as it is.
[[nodiscard]] std::vector<MeanEstimate> coverage_over_views(std::span<const CampaignRun> runs, const std::string& scene,
                                                            const std::string& strategy);

/// Final coverage of strategy `a` minus that of `b`, in the seeds of the scene that both have. What a seed does to both
/// cancels out, so that this tells more than two intervals side by side.
[[nodiscard]] MeanEstimate coverage_gap(std::span<const CampaignRun> runs, const std::string& scene,
                                        const std::string& a, const std::string& b);

}  // namespace saccade
