// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/campaign_summary.hpp"

#include <algorithm>

namespace saccade {
namespace {

using Runs = std::vector<const CampaignRun*>;

Runs runs_of(std::span<const CampaignRun> runs, const std::string& scene, const std::string& strategy) {
  Runs chosen;
  for (const CampaignRun& run : runs) {
    if (run.key.scene == scene && run.key.strategy == strategy) chosen.push_back(&run);
  }
  return chosen;
}

/// The mean of what `figure` makes of each run; runs without that figure are left out.
template <class Figure>
MeanEstimate mean_of(const Runs& runs, Figure figure) {
  std::vector<double> values;
  for (const CampaignRun* run : runs) {
    const std::optional<double> value = figure(*run);
    if (value) values.push_back(*value);
  }
  return estimate_mean(values);
}

std::optional<double> as_number(std::size_t count) { return static_cast<double>(count); }

CampaignSummary summary_of(const Runs& runs) {
  using Run = CampaignRun;
  CampaignSummary summary;
  summary.scene = runs.front()->key.scene;
  summary.strategy = runs.front()->key.strategy;
  summary.initial_coverage = mean_of(runs, [](const Run& run) { return std::optional{run.initial.coverage}; });
  summary.coverage = mean_of(runs, [](const Run& run) { return std::optional{run.final().coverage}; });
  summary.unknown_near_objects =
      mean_of(runs, [](const Run& run) { return as_number(run.final().unknown_near_objects); });
  summary.f_score = mean_of(runs, [](const Run& run) { return run.final().f_score; });
  summary.accuracy_m = mean_of(runs, [](const Run& run) { return run.final().accuracy_m; });
  summary.views = mean_of(runs, [](const Run& run) { return as_number(run.views.size()); });
  summary.seconds = mean_of(runs, [](const Run& run) { return std::optional{run.seconds}; });
  return summary;
}

}  // namespace

std::vector<CampaignSummary> summarize(std::span<const CampaignRun> runs) {
  std::vector<CampaignSummary> summaries;
  for (const CampaignRun& run : runs) {
    const bool known = std::any_of(summaries.begin(), summaries.end(), [&run](const CampaignSummary& summary) {
      return summary.scene == run.key.scene && summary.strategy == run.key.strategy;
    });
    if (!known) summaries.push_back(summary_of(runs_of(runs, run.key.scene, run.key.strategy)));
  }
  return summaries;
}

std::vector<MeanEstimate> coverage_over_views(std::span<const CampaignRun> runs, const std::string& scene,
                                              const std::string& strategy) {
  const Runs chosen = runs_of(runs, scene, strategy);
  if (chosen.empty()) return {};
  std::size_t longest = 0;
  for (const CampaignRun* run : chosen) longest = std::max(longest, run->views.size());
  std::vector<MeanEstimate> curve;
  for (std::size_t taken = 0; taken <= longest; ++taken) {
    curve.push_back(mean_of(chosen, [taken](const CampaignRun& run) {
      const std::size_t last = std::min(taken, run.views.size());
      return std::optional{last == 0 ? run.initial.coverage : run.views[last - 1].after.coverage};
    }));
  }
  return curve;
}

MeanEstimate coverage_gap(std::span<const CampaignRun> runs, const std::string& scene, const std::string& a,
                          const std::string& b) {
  const Runs of_b = runs_of(runs, scene, b);
  return mean_of(runs_of(runs, scene, a), [&of_b](const CampaignRun& run) -> std::optional<double> {
    const auto twin = std::find_if(of_b.begin(), of_b.end(),
                                   [&run](const CampaignRun* other) { return other->key.seed == run.key.seed; });
    if (twin == of_b.end()) return std::nullopt;
    return run.final().coverage - (*twin)->final().coverage;
  });
}

}  // namespace saccade
