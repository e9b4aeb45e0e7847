// SPDX-License-Identifier: Apache-2.0
#include "benchmark_table.hpp"

#include <algorithm>
#include <map>

namespace saccade::cli {
namespace {

/// Numbers of views at which our strategies are told: those of published figures, and the protocol's own.
std::set<std::size_t> told_views(const Benchmark& benchmark) {
  std::set<std::size_t> views{benchmark.views_in_all};
  for (const PublishedFigure& figure : benchmark.published) {
    views.insert(std::min(benchmark.views_in_all, static_cast<std::size_t>(figure.views)));
  }
  return views;
}

std::vector<std::string> strategies_in(const ComparedRuns& compared) {
  std::vector<std::string> strategies;
  for (const CampaignSummary& summary : compared.summaries) {
    const std::string& name = summary.group.strategy;
    if (std::find(strategies.begin(), strategies.end(), name) == strategies.end()) strategies.push_back(name);
  }
  return strategies;
}

/// Scene and seed, which runs of different strategies have in common.
using SceneAndSeed = std::pair<std::string, std::uint64_t>;

/// Places of which all strategies have a run, and the runs there.
class SharedRuns {
 public:
  /// @param of_one_seed  strategies whose run of a scene stands for every seed
  SharedRuns(const std::vector<std::string>& strategies, const ComparedRuns& compared,
             const std::set<std::string>& of_one_seed)
      : of_one_seed_{of_one_seed} {
    std::map<SceneAndSeed, std::set<std::string>> run_by;
    std::map<std::string, std::set<std::string>> any_seed_by;
    for (const CampaignEntry& run : compared.runs) {
      run_by[{run.key.scene, run.key.seed}].insert(run.key.strategy);
      if (stands_for_all_seeds(run.key)) any_seed_by[run.key.scene].insert(run.key.strategy);
    }
    for (auto& [place, by] : run_by) {
      by.insert(any_seed_by[place.first].begin(), any_seed_by[place.first].end());
      if (by.size() != strategies.size()) continue;
      places_.insert(place);
      scenes_.insert(place.first);
    }
  }

  [[nodiscard]] std::size_t places() const { return places_.size(); }

  /// Returns those of the runs, measured or of a campaign, that are shared.
  template <class Run>
  [[nodiscard]] std::vector<Run> among(const std::vector<Run>& runs) const {
    std::vector<Run> kept;
    std::copy_if(runs.begin(), runs.end(), std::back_inserter(kept), [&](const Run& run) {
      return stands_for_all_seeds(run.key) ? scenes_.count(run.key.scene) > 0
                                           : places_.count({run.key.scene, run.key.seed}) > 0;
    });
    return kept;
  }

 private:
  [[nodiscard]] bool stands_for_all_seeds(const CampaignKey& run) const { return of_one_seed_.count(run.strategy) > 0; }

  const std::set<std::string>& of_one_seed_;
  std::set<SceneAndSeed> places_;
  std::set<std::string> scenes_;
};

BenchmarkRow row_after(const Benchmark& benchmark, const std::vector<MeasuredRun>& measured,
                       const std::string& strategy, std::size_t views) {
  const auto over = [&](const CurveFigure& figure) {
    return over_objects(object_figures(benchmark, measured, strategy, figure));
  };
  BenchmarkRow row;
  row.method = strategy;
  row.views = static_cast<double>(views);
  row.taken = over([views](const BenchmarkCurve& curve) { return static_cast<double>(std::min(views, curve.taken)); });
  row.of_visible = over(share_after(views, &CoverageShares::of_visible));
  row.of_all = over(share_after(views, &CoverageShares::of_all));
  return row;
}

BenchmarkRow row_of_own_scenes(const std::vector<CampaignSummary>& summaries, const std::string& strategy) {
  const auto over = [&](const char* figure) { return over_objects(object_figures(summaries, strategy, figure)); };
  BenchmarkRow row;
  row.method = strategy;
  row.views = over("views").mean;
  row.of_visible = over("coverage");
  row.path_m = over("path_m");
  row.motion_s = over("motion_s");
  return row;
}

}  // namespace

std::vector<std::string> objects_of(const Benchmark& benchmark, const std::vector<Scene>& scenes) {
  std::vector<std::string> objects;
  for (const Scene& scene : scenes) {
    std::string object = object_of(benchmark, scene.name);
    if (std::find(objects.begin(), objects.end(), object) == objects.end()) objects.push_back(std::move(object));
  }
  return objects;
}

BenchmarkTable benchmark_table(const Benchmark& benchmark, const BenchmarkPlan& plan,
                               const std::vector<MeasuredRun>& measured, const ComparedRuns& compared,
                               const std::set<std::string>& of_one_seed, std::size_t planned) {
  const std::vector<std::string> strategies = strategies_in(compared);
  const SharedRuns shared{strategies, compared, of_one_seed};
  BenchmarkTable table{{}, {}, planned, compared.runs.size(), shared.places()};
  if (benchmark.rule && shared.places() > 0) {
    const std::vector<MeasuredRun> runs = shared.among(measured);
    for (const std::string& strategy : strategies) {
      for (const std::size_t views : told_views(benchmark)) {
        table.rows.push_back(row_after(benchmark, runs, strategy, views));
      }
    }
    table.differences = object_differences(benchmark, runs, strategies);
  } else if (shared.places() > 0) {
    const std::vector<CampaignSummary> summaries = summarize(shared.among(compared.runs), compared.budget);
    for (const std::string& strategy : strategies) table.rows.push_back(row_of_own_scenes(summaries, strategy));
    table.differences = object_differences(benchmark, summaries, strategies);
  }
  for (const PublishedFigure& figure : benchmark.published) {
    BenchmarkRow row;
    row.method = figure.method;
    row.views = figure.views;
    row.published = figure;
    row.same_object = has_same_object(benchmark, plan, figure);
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace saccade::cli
