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

/// Values of a measure over runs, or over scenes with the mean of their runs.
class Sample {
 public:
  explicit Sample(bool by_scene) : by_scene_{by_scene} {}

  void add(const CampaignEntry& run, std::optional<double> value) {
    if (!value) return;
    if (!by_scene_) return values_.push_back(*value);
    // Runs of one scene follow each other, as a rule.
    if (scene_ >= scenes_.size() || scenes_[scene_].first != run.key.scene) {
      scene_ = static_cast<std::size_t>(
          std::find_if(scenes_.begin(), scenes_.end(), [&](const auto& of) { return of.first == run.key.scene; }) -
          scenes_.begin());
    }
    if (scene_ == scenes_.size()) scenes_.emplace_back(run.key.scene, std::vector<double>{});
    scenes_[scene_].second.push_back(*value);
  }

  [[nodiscard]] MeanEstimate estimate() const {
    if (!by_scene_) return estimate_mean(values_);
    std::vector<double> means;
    for (const auto& [name, values] : scenes_) means.push_back(mean(values));
    return estimate_mean(means);
  }

 private:
  bool by_scene_;
  std::vector<double> values_;
  std::vector<std::pair<std::string_view, std::vector<double>>> scenes_;
  std::size_t scene_{0};  ///< the last one
};

/// Returns the means of measure(run, i) for i below `count`, over the runs that have it. Takes run by run, since the
/// views of many runs do not fit into a cache.
template <class Measure>
std::vector<MeanEstimate> means_of(const Runs& runs, bool by_scene, std::size_t count, const Measure& measure) {
  std::vector<Sample> samples(count, Sample{by_scene});
  for (const CampaignEntry* run : runs) {
    for (std::size_t i = 0; i < count; ++i) samples[i].add(*run, measure(*run, i));
  }
  std::vector<MeanEstimate> means;
  for (const Sample& sample : samples) means.push_back(sample.estimate());
  return means;
}

CampaignSummary summary_of(const Runs& runs, CampaignGroup group, std::size_t budget) {
  CampaignSummary summary;
  const bool by_scene = !group.scene;
  summary.group = std::move(group);
  summary.runs = runs.size();
  const std::span<const RunFigure> figures = run_figures();
  summary.figures = means_of(runs, by_scene, figures.size(),
                             [&](const CampaignEntry& run, std::size_t i) { return figures[i].of(run, budget); });
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
  if (chosen.empty()) return {};
  return means_of(chosen, !group.scene, budget + 1, [figure](const CampaignEntry& run, std::size_t taken) {
    return std::optional{figure(figures_after(run, taken))};
  });
}

std::vector<MeanEstimate> object_view_shares(std::span<const CampaignEntry> runs, const CampaignGroup& group) {
  const Runs chosen = runs_of(runs, group);
  const auto points_at_object = [](const CampaignEntry& run, std::size_t k) -> std::optional<double> {
    if (k >= run.run.views.size()) return std::nullopt;
    return run.run.views[k].reveals_object.value_or(false) ? 1.0 : 0.0;
  };
  return means_of(chosen, !group.scene, kFirstViews, points_at_object);
}

std::vector<MeanEstimate> paired_gaps(std::span<const CampaignEntry> runs, const CampaignGroup& a,
                                      const CampaignGroup& b, std::size_t budget) {
  SACCADE_EXPECTS(a.scene == b.scene);
  std::map<std::pair<std::string, std::uint64_t>, const CampaignEntry*> of_b;
  for (const CampaignEntry* run : runs_of(runs, b)) of_b.try_emplace({run->key.scene, run->key.seed}, run);
  const std::span<const RunFigure> figures = run_figures();
  std::vector<Sample> gaps(figures.size(), Sample{!a.scene});
  for (const CampaignEntry* run : runs_of(runs, a)) {
    const auto twin = of_b.find({run->key.scene, run->key.seed});
    if (twin == of_b.end()) continue;
    for (std::size_t i = 0; i < figures.size(); ++i) {
      const std::optional<double> of_run = figures[i].of(*run, budget);
      const std::optional<double> of_twin = figures[i].of(*twin->second, budget);
      if (of_run && of_twin) gaps[i].add(*run, *of_run - *of_twin);
    }
  }
  std::vector<MeanEstimate> means;
  for (const Sample& gap : gaps) means.push_back(gap.estimate());
  return means;
}

}  // namespace saccade
