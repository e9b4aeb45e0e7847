// SPDX-License-Identifier: Apache-2.0
#include "compare_report.hpp"

#include <algorithm>

#include "saccade/report/html_text.hpp"
#include "saccade/report/run_report_parts.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using Summaries = std::vector<const CampaignSummary*>;

Summaries summaries_of(const ComparedRuns& compared, const std::optional<std::string>& scene) {
  Summaries summaries;
  for (const CampaignSummary& summary : compared.summaries) {
    if (summary.group.scene == scene) summaries.push_back(&summary);
  }
  return summaries;
}

std::string spaced(std::string_view name) {
  std::string text{name};
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

/// "sphere: 8 of 10 runs stopped for regions done, 2 for views used up."
std::string stops_text(const CampaignSummary& summary, const std::string& label) {
  std::string text = label + ": ";
  bool first = true;
  for (const auto& [reason, runs] : summary.stopped) {
    text += first ? std::to_string(runs) + " of " + std::to_string(summary.runs) + " runs stopped for "
                  : ", " + std::to_string(runs) + " for ";
    text += spaced(reason);
    first = false;
  }
  return text;
}

/// Whether it says no more than 0, such as refusals of a camera that flies.
bool says_nothing(const ComparisonRow& row) {
  return std::all_of(row.cells.begin(), row.cells.end(),
                     [](const std::string& cell) { return cell.find_first_of("123456789") == std::string::npos; });
}

void add_figures(ComparisonSection& section, const ComparedRuns& compared, const Summaries& summaries,
                 std::size_t of_scenes) {
  std::vector<const StrategyGap*> gaps;
  for (const StrategyGap& gap : compared.gaps) {
    if (gap.a.scene == summaries.front()->group.scene) gaps.push_back(&gap);
  }
  for (const CampaignSummary* summary : summaries) section.columns.push_back(label_of(summary->group, compared));
  for (const StrategyGap* gap : gaps) {
    section.columns.push_back(gap_label(*gap, compared, "\u2212") + ", paired");
  }
  for (std::size_t i = 0; i < run_figures().size(); ++i) {
    const RunFigure& figure = run_figures()[i];
    ComparisonRow row{figure.text, {}};
    if (!figure.unit.empty()) row.name += ", " + std::string{figure.unit};
    for (const CampaignSummary* summary : summaries) {
      const std::size_t all = summary->group.scene ? summary->runs : of_scenes;
      row.cells.push_back(estimate_text(figure, summary->figures[i], all));
    }
    for (const StrategyGap* gap : gaps) {
      row.cells.push_back(estimate_text(figure, gap->figures[i], gap->figures[i].n));
    }
    if (!says_nothing(row)) section.rows.push_back(std::move(row));
  }
}

void add_marks(ComparisonSection& section, const ComparedRuns& compared, const Summaries& summaries) {
  for (const CampaignSummary* summary : summaries) {
    const std::string label = label_of(summary->group, compared);
    ComparisonRow row{label, {}};
    for (const MeanEstimate& share : object_view_shares(compared.runs, summary->group)) {
      row.cells.push_back(share.n == 0 ? std::string{} : number_text(100.0 * share.mean, 0) + " %");
    }
    section.shares.push_back(std::move(row));
    if (!summary->group.scene) continue;
    for (const CampaignEntry& run : compared.runs) {
      const CampaignGroup group{run.key.scene, run.key.strategy, run.key.noise};
      if (group != summary->group || run.run.views.empty()) continue;
      ComparisonMarks marks{label, "seed " + std::to_string(run.key.seed), {}};
      for (std::size_t k = 0; k < std::min(kFirstViews, run.run.views.size()); ++k) {
        marks.marks.push_back(run.run.views[k].reveals_object.value_or(false));
      }
      section.marks.push_back(std::move(marks));
    }
  }
}

void add_times(ComparisonSection& section, const ComparedRuns& compared, const Summaries& summaries) {
  for (const Phase phase : kPhaseNames.values) section.phases.push_back(spaced(to_string(phase)));
  for (const CampaignSummary* summary : summaries) {
    ComparisonTimes times{label_of(summary->group, compared), {}};
    for (const Phase phase : kPhaseNames.values)
      times.ms.push_back(summary->of(std::string{to_string(phase)} + "_ms").mean);
    section.times.push_back(std::move(times));
  }
}

ComparisonSection section_of(const ComparedRuns& compared, const std::optional<std::string>& scene,
                             std::size_t of_scenes) {
  const Summaries summaries = summaries_of(compared, scene);
  ComparisonSection section;
  section.title = scene.value_or("All scenes");
  if (scene) {
    for (const CampaignSummary* summary : summaries) {
      section.facts.push_back(stops_text(*summary, label_of(summary->group, compared)));
    }
  } else {
    section.facts.emplace_back("Each scene counts once, with the mean of its runs; the intervals are over scenes.");
  }
  for (const CampaignSummary* summary : summaries) {
    if (summary->calibration.views == 0) continue;
    section.facts.push_back(label_of(summary->group, compared) + ": " + calibration_text(summary->calibration) + ".");
  }
  section.plots = {coverage_plot(compared, scene), unknown_plot(compared, scene)};
  add_figures(section, compared, summaries, of_scenes);
  add_marks(section, compared, summaries);
  add_times(section, compared, summaries);
  return section;
}

std::string counted(std::size_t count, const std::string& what) {
  return grouped(count) + ' ' + what + (count == 1 ? "" : "s");
}

/// The first strategy against the others, over all scenes or in the only one.
std::string verdict(const ComparedRuns& compared, std::size_t planned) {
  std::string text = counted(compared.runs.size(), "run");
  if (compared.runs.size() < planned) text += " of " + grouped(planned) + ", the others are still to be done";
  text += '.';
  for (const StrategyGap& gap : compared.gaps) {
    const bool several = compared.summaries.back().group.scene == std::nullopt;
    const MeanEstimate& area = gap.of("coverage_area");
    if (gap.a.scene.has_value() == several || area.n == 0) continue;
    text +=
        " Area under the coverage, " + gap_label(gap, compared, "\u2212") + ": " + signed_text(100.0 * area.mean, 1);
    if (area.half_width) text += " ± " + number_text(100.0 * *area.half_width, 1);
    text += " points.";
  }
  return text;
}

}  // namespace

ComparisonReport comparison_report(const Comparison& comparison, const ComparedRuns& compared, std::size_t planned) {
  const CompareOptions& options = comparison.options();
  ComparisonReport report;
  report.title = "Strategies compared";
  report.version = SACCADE_VERSION;
  std::vector<std::string> strategies;
  for (const NamedPlanner& strategy : options.strategies) strategies.push_back(strategy.name);
  report.settings = {{"strategies", joined(strategies)},
                     {"robot", comparison.robot_name()},
                     {"noise", joined(options.noises)},
                     {"views at most", std::to_string(comparison.budget())}};
  report.verdict = verdict(compared, planned);
  std::vector<std::string> scenes;
  for (const CampaignSummary& summary : compared.summaries) {
    const bool new_one = summary.group.scene && (scenes.empty() || scenes.back() != *summary.group.scene);
    if (new_one) scenes.push_back(*summary.group.scene);
  }
  if (scenes.size() > 1) report.sections.push_back(section_of(compared, std::nullopt, scenes.size()));
  for (const std::string& scene : scenes) report.sections.push_back(section_of(compared, scene, scenes.size()));
  report.facts = {{"scenes", std::to_string(comparison.scenes().size())},
                  {"seeds", std::to_string(options.seeds.size())},
                  {"equal views", options.equal_views ? "every strategy as many as sphere took" : ""},
                  {"voxel size", millimetres(options.run.run.voxel_size_m)},
                  {"gain threshold", options.run.min_gain ? gain_text(*options.run.min_gain) : min_gain_by_strategy()}};
  report.links = {{"runs.csv", "a row per run"},
                  {"views.csv", "a row per view"},
                  {"summary.csv", "means and intervals"},
                  {"campaign.sqlite", "all runs ever done in this folder"}};
  return report;
}

}  // namespace saccade::cli
