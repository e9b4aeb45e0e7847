// SPDX-License-Identifier: Apache-2.0
#include "compare_output.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "json_output.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/trial/campaign_summary.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr std::string_view kAllScenes{"all scenes"};

/// Filled with blanks up to `width` characters; "±" is one of them.
std::string padded(const std::string& text, std::size_t width) {
  const auto characters = static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
  return text + std::string(characters < width ? width - characters : 1, ' ');
}

Plot plot_of(const ComparedRuns& compared, const std::optional<std::string>& scene, MapFigure figure, double scale) {
  Plot plot;
  plot.x_label = "views after the initial scan";
  plot.min_x_step = 1.0;
  plot.width_px = 620;
  plot.height_px = 380;
  for (const CampaignSummary& summary : compared.summaries) {
    if (summary.group.scene != scene) continue;
    PlotSeries series{label_of(summary.group, compared), {}, {}};
    const std::vector<MeanEstimate> means = over_views(compared.runs, summary.group, compared.budget, figure);
    for (std::size_t taken = 0; taken < means.size(); ++taken) {
      series.x.push_back(static_cast<double>(taken));
      series.y.push_back(scale * means[taken].mean);
      series.low.push_back(scale * means[taken].low().value_or(std::nan("")));
      series.high.push_back(scale * means[taken].high().value_or(std::nan("")));
    }
    plot.series.push_back(std::move(series));
  }
  plot.x_range = {0.0, std::max(1.0, static_cast<double>(compared.budget))};
  return plot;
}

/// The least and the greatest of the curves. Bands of two or three runs would leave them no room.
std::pair<double, double> extent_of(const Plot& plot) {
  std::pair<double, double> extent{std::numeric_limits<double>::infinity(), 0.0};
  for (const PlotSeries& series : plot.series) {
    for (const double value : series.y) {
      extent = {std::min(extent.first, value), std::max(extent.second, value)};
    }
  }
  return extent;
}

std::string cell(const CampaignSummary& summary, std::string_view name) {
  const std::size_t figure = run_figure_index(name);
  const std::string text = estimate_text(run_figures()[figure], summary.figures[figure], summary.figures[figure].n);
  return text.empty() ? "-" : text;
}

json calibration_json(const Calibration& calibration) {
  return {{"views", calibration.views},
          {"rank_correlation", optional_json(calibration.rank_correlation)},
          {"median_kept", optional_json(calibration.median_kept)},
          {"broken", calibration.broken}};
}

/// One line about a gap.
void print_gap(std::ostream& out, const StrategyGap& gap, const ComparedRuns& compared) {
  const MeanEstimate& coverage = gap.of("coverage");
  if (coverage.n == 0) return;
  const auto text = [&gap](std::string_view name) {
    const std::size_t figure = run_figure_index(name);
    return estimate_text(run_figures()[figure], gap.figures[figure], gap.figures[figure].n);
  };
  out << padded(gap.a.scene.value_or(std::string{kAllScenes}), 18) << gap_label(gap, compared, "-") << ": "
      << text("coverage") << " points of coverage at the end, " << text("coverage_area")
      << " of its area over views, by " << (gap.a.scene ? "seed" : "scene") << "; ";
  if (coverage.half_width) {
    out << "the intervals of the means are " << (gap.apart ? "apart\n" : "not apart\n");
  } else {
    out << "one " << (gap.a.scene ? "seed" : "scene") << " has no interval\n";
  }
}

}  // namespace

json estimate_json(const MeanEstimate& estimate) {
  return {{"n", estimate.n},
          {"mean", estimate.n == 0 ? json(nullptr) : json(estimate.mean)},
          {"low", optional_json(estimate.low())},
          {"high", optional_json(estimate.high())}};
}

ComparedRuns compared(std::vector<CampaignEntry> runs, std::size_t budget) {
  ComparedRuns compared{std::move(runs), budget, {}, {}};
  compared.summaries = summarize(compared.runs, budget);
  for (const CampaignSummary& b : compared.summaries) {
    const auto a = std::find_if(compared.summaries.begin(), compared.summaries.end(), [&b](const auto& summary) {
      return summary.group.scene == b.group.scene && summary.group.noise == b.group.noise;
    });
    if (a->group == b.group) continue;
    compared.gaps.push_back({a->group, b.group, paired_gaps(compared.runs, a->group, b.group, budget),
                             are_apart(a->of("initial_coverage"), b.of("initial_coverage")),
                             are_apart(a->of("coverage"), b.of("coverage"))});
  }
  return compared;
}

std::string label_of(const CampaignGroup& group, const ComparedRuns& compared) {
  const bool several =
      std::any_of(compared.summaries.begin(), compared.summaries.end(),
                  [&group](const CampaignSummary& summary) { return summary.group.noise != group.noise; });
  return several ? group.strategy + ", " + group.noise : group.strategy;
}

std::string gap_label(const StrategyGap& gap, const ComparedRuns& compared, const std::string& minus) {
  return gap.a.strategy + ' ' + minus + ' ' + label_of(gap.b, compared);
}

Plot coverage_plot(const ComparedRuns& compared, const std::optional<std::string>& scene) {
  Plot plot = plot_of(
      compared, scene, [](const Measures& map) { return map.coverage.value_or(0.0); }, 100.0);
  plot.title = "Coverage: " + scene.value_or("mean over all scenes");
  plot.y_label = "coverage, %";
  const double lowest = std::min(90.0, extent_of(plot).first - 5.0);
  plot.y_range = {std::max(0.0, 10.0 * std::floor(0.1 * lowest)), 100.0};
  return plot;
}

Plot unknown_plot(const ComparedRuns& compared, const std::optional<std::string>& scene) {
  Plot plot = plot_of(
      compared, scene, [](const Measures& map) { return static_cast<double>(map.unknown_near_objects.value_or(0)); },
      1.0);
  plot.title = "Unknown near objects: " + scene.value_or("mean over all scenes");
  plot.y_label = "voxels";
  plot.y_range = {0.0, std::max(1.0, 1.25 * extent_of(plot).second)};
  return plot;
}

/// Returns the scene's name as that of a file, with a number where another scene has it: "a b" and "a-b" differ.
std::string file_name_of(const std::string& scene, std::set<std::string>& taken) {
  constexpr std::string_view kPlain{"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-"};
  std::string name = scene;
  std::replace_if(
      name.begin(), name.end(), [&](char c) { return kPlain.find(c) == std::string_view::npos; }, '-');
  std::string free = name;
  for (int i = 2; !taken.insert(free).second; ++i) free = name + '-' + std::to_string(i);
  return free + ".svg";
}

Status write_comparison(const std::filesystem::path& folder, const ComparedRuns& compared, const Executor& executor) {
  std::array<Status, 2> written;
  executor.parallel_for(written.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      written[i] = i == 0 ? write_views_csv(folder / "views.csv", compared.runs)
                          : write_runs_csv(folder / "runs.csv", compared.runs, compared.budget);
    }
  });
  for (const Status& status : written) SACCADE_CHECK(status);
  SACCADE_CHECK(summary_csv(compared.summaries).write(folder / "summary.csv"));
  std::string drawn;
  std::set<std::string> taken;
  for (const CampaignSummary& summary : compared.summaries) {  // those of one scene follow each other
    if (!summary.group.scene || *summary.group.scene == drawn) continue;
    drawn = *summary.group.scene;
    const std::string name = file_name_of(drawn, taken);
    SACCADE_CHECK(write_file_atomically(folder / ("coverage-" + name), plot_svg(coverage_plot(compared, drawn))));
    SACCADE_CHECK(write_file_atomically(folder / ("unknown-" + name), plot_svg(unknown_plot(compared, drawn))));
  }
  return {};
}

std::string estimate_text(const RunFigure& figure, const MeanEstimate& estimate, std::size_t of) {
  if (estimate.n == 0) return {};
  std::string text = fixed(figure.scale * estimate.mean, figure.decimals);
  if (text.find_first_of("123456789") == std::string::npos && text.front() == '-') text.erase(0, 1);
  if (estimate.half_width) text += " ± " + fixed(figure.scale * *estimate.half_width, figure.decimals);
  if (estimate.n != of) text += " (" + std::to_string(estimate.n) + " of " + std::to_string(of) + ")";
  return text;
}

std::string calibration_text(const Calibration& calibration) {
  std::string text = std::to_string(calibration.views) + (calibration.views == 1 ? " view" : " views") + " kept " +
                     fixed(100.0 * *calibration.median_kept, 0) + " % of what they promised (median)";
  if (calibration.rank_correlation) text += "; rank correlation " + fixed(*calibration.rank_correlation, 2);
  return text + "; " + std::to_string(calibration.broken) + " kept less than a tenth";
}

void print_comparison(std::ostream& out, const ComparedRuns& compared) {
  constexpr std::size_t kName{18};
  constexpr std::size_t kFigure{14};
  std::size_t label = kName;
  for (const CampaignSummary& summary : compared.summaries) {
    label = std::max(label, label_of(summary.group, compared).size() + 2);
  }
  // Many scenes: only their joint result is shown here; the page and the tables have each scene.
  constexpr std::size_t kMostLines{24};
  const bool brief = compared.summaries.size() > kMostLines;
  const auto is_told = [&](const CampaignGroup& group) { return !brief || !group.scene; };
  out << padded("scene", kName) << padded("strategy", label) << padded("runs", 6);
  for (const char* head : {"scan, %", "end, %", "area, %", "views"}) out << padded(head, kFigure);
  out << "unknown near objects\n";
  for (const CampaignSummary& summary : compared.summaries) {
    if (!is_told(summary.group)) continue;
    out << padded(summary.group.scene.value_or(std::string{kAllScenes}), kName)
        << padded(label_of(summary.group, compared), label) << padded(std::to_string(summary.runs), 6);
    for (const char* name : {"initial_coverage", "coverage", "coverage_area", "views"}) {
      out << padded(cell(summary, name), kFigure);
    }
    out << cell(summary, "unknown_near_objects") << '\n';
  }
  for (const CampaignSummary& summary : compared.summaries) {
    if (!is_told(summary.group) || summary.calibration.views == 0) continue;
    out << padded(summary.group.scene.value_or(std::string{kAllScenes}), kName) << label_of(summary.group, compared)
        << ": " << calibration_text(summary.calibration) << '\n';
  }
  for (const StrategyGap& gap : compared.gaps) {
    if (is_told(gap.a)) print_gap(out, gap, compared);
  }
}

json comparison_json(const ComparedRuns& compared) {
  json rows = json::array();
  for (const CampaignSummary& summary : compared.summaries) {
    json row{{"scene", optional_json(summary.group.scene)},
             {"strategy", summary.group.strategy},
             {"noise", summary.group.noise},
             {"runs", summary.runs},
             {"stopped_because", summary.stopped},
             {"promises", calibration_json(summary.calibration)}};
    for (std::size_t i = 0; i < summary.figures.size(); ++i) {
      row[run_figures()[i].name] = estimate_json(summary.figures[i]);
    }
    json shares = json::array();
    for (const MeanEstimate& share : object_view_shares(compared.runs, summary.group)) {
      shares.push_back(estimate_json(share));
    }
    row["points_at_object"] = std::move(shares);
    rows.push_back(std::move(row));
  }
  json differences = json::array();
  for (const StrategyGap& gap : compared.gaps) {
    json row{{"scene", optional_json(gap.a.scene)},
             {"noise", gap.a.noise},
             {"a", gap.a.strategy},
             {"b", gap.b.strategy},
             {"apart", gap.apart},
             {"apart_initially", gap.apart_initially}};
    for (const char* name : {"coverage", "coverage_area", "unknown_near_objects_at_5", "unknown_near_objects"}) {
      row[name] = estimate_json(gap.of(name));
    }
    differences.push_back(std::move(row));
  }
  return {{"summaries", std::move(rows)}, {"gaps", std::move(differences)}};
}

}  // namespace saccade::cli
