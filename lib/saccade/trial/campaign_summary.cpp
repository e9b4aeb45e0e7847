// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/campaign_summary.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/core/result.hpp"

namespace saccade {
namespace {

using Runs = std::vector<const CampaignEntry*>;

bool is_of(const CampaignEntry& run, const CampaignGroup& group) {
  return (!group.scene || run.key.scene == *group.scene) && run.key.strategy == group.strategy &&
         run.key.noise == group.noise;
}

Runs runs_of(std::span<const CampaignEntry> runs, const CampaignGroup& group) {
  Runs chosen;
  for (const CampaignEntry& run : runs) {
    if (is_of(run, group)) chosen.push_back(&run);
  }
  return chosen;
}

/// Returns the mean of `figure` over runs, or over scenes, without those that lack it. Calls it once for each run, in
/// their order.
template <class Figure>
MeanEstimate mean_of(const Runs& runs, bool by_scene, const Figure& figure) {
  std::vector<std::string_view> scenes;
  std::vector<std::vector<double>> values;  // by scene
  std::vector<double> means;
  std::size_t scene = 0;  // runs of one scene follow each other, as a rule
  for (const CampaignEntry* run : runs) {
    const std::optional<double> value = figure(*run);
    if (!value) continue;
    if (!by_scene) {
      means.push_back(*value);
      continue;
    }
    if (scene >= scenes.size() || scenes[scene] != run->key.scene) {
      scene = static_cast<std::size_t>(std::find(scenes.begin(), scenes.end(), run->key.scene) - scenes.begin());
    }
    if (scene == scenes.size()) {
      scenes.emplace_back(run->key.scene);
      values.emplace_back();
    }
    values[scene].push_back(*value);
  }
  for (const std::vector<double>& of_scene : values) means.push_back(mean(of_scene));
  return estimate_mean(means);
}

CampaignSummary summary_of(const Runs& runs, CampaignGroup group, std::size_t budget) {
  CampaignSummary summary;
  const bool by_scene = !group.scene;
  summary.group = std::move(group);
  summary.runs = runs.size();
  for (const RunFigure& figure : run_figures()) {
    summary.figures.push_back(
        mean_of(runs, by_scene, [&](const CampaignEntry& run) { return figure.of(run, budget); }));
  }
  std::vector<const ViewRecord*> views;
  for (const CampaignEntry* run : runs) {
    ++summary.stopped[std::string{to_string(run->run.stopped_because)}];
    for (const ViewRecord& view : run->run.views) views.push_back(&view);
  }
  summary.calibration = calibration_of(views);
  return summary;
}

}  // namespace

Calibration calibration_of(std::span<const ViewRecord* const> views) {
  std::vector<double> promised;
  std::vector<double> observed;
  std::vector<double> kept;
  for (const ViewRecord* view : views) {
    if (!std::isfinite(view->gain_observed) || !(view->gain_predicted > 0.0)) continue;
    promised.push_back(view->gain_predicted);
    observed.push_back(view->gain_observed);
    kept.push_back(view->gain_observed / view->gain_predicted);
  }
  Calibration calibration;
  calibration.views = kept.size();
  calibration.rank_correlation = rank_correlation(promised, observed);
  if (!kept.empty()) calibration.median_kept = median(kept);
  calibration.broken = static_cast<std::size_t>(
      std::count_if(kept.begin(), kept.end(), [](double share) { return share < kBrokenShare; }));
  return calibration;
}

std::vector<CampaignSummary> summarize(std::span<const CampaignEntry> runs, std::size_t budget) {
  std::vector<CampaignGroup> groups;
  const auto add = [&groups](CampaignGroup group) {
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(std::move(group));
  };
  for (const CampaignEntry& run : runs) add({run.key.scene, run.key.strategy, run.key.noise});
  const bool several = std::any_of(runs.begin(), runs.end(),
                                   [&](const CampaignEntry& run) { return run.key.scene != runs.front().key.scene; });
  if (several) {
    for (const CampaignEntry& run : runs) add({std::nullopt, run.key.strategy, run.key.noise});
  }
  std::vector<CampaignSummary> summaries;
  for (CampaignGroup& group : groups) {
    const Runs of_group = runs_of(runs, group);
    summaries.push_back(summary_of(of_group, std::move(group), budget));
  }
  return summaries;
}

std::vector<MeanEstimate> over_views(std::span<const CampaignEntry> runs, const CampaignGroup& group,
                                     std::size_t budget, MapFigure figure) {
  const Runs chosen = runs_of(runs, group);
  std::vector<MeanEstimate> curve;
  if (chosen.empty()) return curve;
  for (std::size_t taken = 0; taken <= budget; ++taken) {
    curve.push_back(mean_of(chosen, !group.scene, [&](const CampaignEntry& run) {
      return std::optional{figure(figures_after(run, taken))};
    }));
  }
  return curve;
}

std::vector<MeanEstimate> object_view_shares(std::span<const CampaignEntry> runs, const CampaignGroup& group) {
  const Runs chosen = runs_of(runs, group);
  std::vector<MeanEstimate> shares;
  for (std::size_t k = 0; k < kFirstViews; ++k) {
    shares.push_back(mean_of(chosen, !group.scene, [k](const CampaignEntry& run) -> std::optional<double> {
      if (k >= run.run.views.size()) return std::nullopt;
      return run.run.views[k].reveals_object.value_or(false) ? 1.0 : 0.0;
    }));
  }
  return shares;
}

std::vector<MeanEstimate> paired_gaps(std::span<const CampaignEntry> runs, const CampaignGroup& a,
                                      const CampaignGroup& b, std::size_t budget) {
  SACCADE_EXPECTS(a.scene == b.scene);
  std::map<std::pair<std::string, std::uint64_t>, const CampaignEntry*> of_b;
  for (const CampaignEntry* run : runs_of(runs, b)) of_b.try_emplace({run->key.scene, run->key.seed}, run);
  const Runs of_a = runs_of(runs, a);
  Runs twins;  // null: there is none
  for (const CampaignEntry* run : of_a) {
    const auto twin = of_b.find({run->key.scene, run->key.seed});
    twins.push_back(twin == of_b.end() ? nullptr : twin->second);
  }
  std::vector<MeanEstimate> gaps;
  for (const RunFigure& figure : run_figures()) {
    std::size_t next = 0;
    gaps.push_back(mean_of(of_a, !a.scene, [&](const CampaignEntry& run) -> std::optional<double> {
      const CampaignEntry* twin = twins[next++];
      if (twin == nullptr) return std::nullopt;
      const std::optional<double> of_run = figure.of(run, budget);
      const std::optional<double> of_twin = figure.of(*twin, budget);
      if (!of_run || !of_twin) return std::nullopt;
      return *of_run - *of_twin;
    }));
  }
  return gaps;
}

}  // namespace saccade
