// SPDX-License-Identifier: Apache-2.0
#include "compare_report.hpp"

#include <algorithm>

#include "json_output.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

json measures_json() {
  json measures = json::array();
  for (const RunFigure& measure : run_figures()) {
    measures.push_back({{"name", measure.name},
                        {"text", measure.text},
                        {"unit", measure.unit},
                        {"scale", measure.scale},
                        {"decimals", measure.decimals}});
  }
  return measures;
}

/// All measures of each gap; the result has a few.
json gaps_json(const ComparedRuns& compared) {
  json gaps = json::array();
  for (const StrategyGap& gap : compared.gaps) {
    json entry{
        {"scene", optional_json(gap.a.scene)}, {"noise", gap.b.noise}, {"a", gap.a.strategy}, {"b", gap.b.strategy}};
    for (std::size_t i = 0; i < gap.figures.size(); ++i) entry[run_figures()[i].name] = estimate_json(gap.figures[i]);
    gaps.push_back(std::move(entry));
  }
  return gaps;
}

/// Values that are not finite become null.
json series_json(const Plot& plot) {
  json all = json::array();
  for (const PlotSeries& series : plot.series) {
    all.push_back(
        {{"name", series.name}, {"x", series.x}, {"y", series.y}, {"low", series.low}, {"high", series.high}});
  }
  return all;
}

/// The scenes of the summaries, in their order; nullopt: all scenes.
std::vector<std::optional<std::string>> scenes_of(const ComparedRuns& compared) {
  std::vector<std::optional<std::string>> scenes;
  for (const CampaignSummary& summary : compared.summaries) {
    const auto& scene = summary.group.scene;
    if (std::find(scenes.begin(), scenes.end(), scene) == scenes.end()) scenes.push_back(scene);
  }
  return scenes;
}

json curves_json(const ComparedRuns& compared) {
  json curves = json::array();
  for (const std::optional<std::string>& scene : scenes_of(compared)) {
    curves.push_back({{"scene", optional_json(scene)},
                      {"coverage", series_json(coverage_plot(compared, scene))},
                      {"unknown", series_json(unknown_plot(compared, scene))}});
  }
  return curves;
}

/// Which of the first views of each run reveal an object, as in Table 3.3 of the thesis.
json marks_json(const ComparedRuns& compared) {
  constexpr std::size_t kMost{5000};  // more than a person reads; views.csv has all
  json all = json::array();
  if (compared.runs.size() > kMost) return all;
  for (const CampaignEntry& run : compared.runs) {
    const CampaignGroup group{run.key.scene, run.key.strategy, run.key.noise};
    json marks = json::array();
    for (std::size_t k = 0; k < std::min(kFirstViews, run.run.views.size()); ++k) {
      marks.push_back(run.run.views[k].reveals_object.value_or(false));
    }
    if (marks.empty()) continue;
    all.push_back({{"scene", run.key.scene},
                   {"label", label_of(group, compared)},
                   {"seed", run.key.seed},
                   {"marks", std::move(marks)}});
  }
  return all;
}

}  // namespace

json comparison_details(const Comparison& comparison, const ComparedRuns& compared) {
  const CompareOptions& options = comparison.options();
  json facts = json::array();
  const auto add = [&facts](const char* name, const std::string& value) {
    facts.push_back({{"name", name}, {"value", value}});
  };
  if (options.equal_views) add("equal views", "every strategy as many as sphere took");
  add("voxel size", millimetres(options.run.run.voxel_size_m));
  add("gain threshold", options.run.min_gain ? fixed(*options.run.min_gain, 1) : min_gain_by_strategy());
  return {{"measures", measures_json()},
          {"gaps", gaps_json(compared)},
          {"curves", curves_json(compared)},
          {"marks", marks_json(compared)},
          {"facts", std::move(facts)}};
}

}  // namespace saccade::cli
