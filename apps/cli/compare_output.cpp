// SPDX-License-Identifier: Apache-2.0
#include "compare_output.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/io/atomic_file.hpp"
#include "saccade/io/campaign_csv.hpp"
#include "saccade/report/plot.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

json estimate_json(const MeanEstimate& estimate) {
  const auto number = [](const std::optional<double>& value) { return value ? json(*value) : json(nullptr); };
  return {{"n", estimate.n},
          {"mean", estimate.n == 0 ? json(nullptr) : json(estimate.mean)},
          {"low", number(estimate.low())},
          {"high", number(estimate.high())}};
}

/// "93.1 ± 0.8", in percent; without a half width where there is none.
std::string percent_text(const MeanEstimate& estimate) {
  std::string text = fixed(100.0 * estimate.mean, 1);
  if (estimate.half_width) text += " ± " + fixed(100.0 * *estimate.half_width, 1);
  return text;
}

/// Filled with blanks up to `width` characters; "±" is one of them.
std::string padded(const std::string& text, std::size_t width) {
  const auto characters = static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
  return text + std::string(characters < width ? width - characters : 1, ' ');
}

PlotSeries curve_of(std::span<const CampaignRun> runs, const CampaignSummary& summary) {
  PlotSeries series{summary.strategy, {}, {}};
  const std::vector<MeanEstimate> means = coverage_over_views(runs, summary.scene, summary.strategy);
  for (std::size_t taken = 0; taken < means.size(); ++taken) {
    const MeanEstimate& estimate = means[taken];
    series.x.push_back(static_cast<double>(taken));
    series.y.push_back(100.0 * estimate.mean);
    series.low.push_back(100.0 * estimate.low().value_or(std::nan("")));
    series.high.push_back(100.0 * estimate.high().value_or(std::nan("")));
  }
  return series;
}

std::string picture_of(const std::string& scene, std::span<const CampaignRun> runs,
                       std::span<const CampaignSummary> summaries) {
  Plot plot;
  plot.title = "Coverage of " + scene + ": mean over seeds, 95 % confidence";
  plot.x_label = "views after the initial scan";
  plot.y_label = "coverage, %";
  plot.min_x_step = 1.0;
  double lowest = 90.0;
  double longest = 1.0;
  for (const CampaignSummary& summary : summaries) {
    if (summary.scene != scene) continue;
    PlotSeries series = curve_of(runs, summary);
    for (const std::vector<double>* values : {&series.y, &series.low}) {
      for (const double value : *values) lowest = std::min(lowest, std::isfinite(value) ? value : lowest);
    }
    longest = std::max(longest, series.x.back());
    plot.series.push_back(std::move(series));
  }
  plot.x_range = {0.0, longest};
  plot.y_range = {std::max(0.0, 10.0 * std::floor(0.1 * lowest)), 100.0};
  return plot_svg(plot);
}

}  // namespace

std::vector<StrategyGap> gaps_of(std::span<const CampaignRun> runs, std::span<const CampaignSummary> summaries) {
  std::vector<StrategyGap> gaps;
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    const CampaignSummary& b = summaries[i];
    const auto a = std::find_if(summaries.begin(), summaries.end(),
                                [&b](const CampaignSummary& summary) { return summary.scene == b.scene; });
    if (a->strategy == b.strategy) continue;
    gaps.push_back({b.scene, a->strategy, b.strategy, coverage_gap(runs, b.scene, a->strategy, b.strategy),
                    are_apart(a->initial_coverage, b.initial_coverage), are_apart(a->coverage, b.coverage)});
  }
  return gaps;
}

std::string picture_name(const std::string& scene) {
  constexpr std::string_view kPlain{"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-"};
  std::string name = scene;
  std::replace_if(
      name.begin(), name.end(), [&](char c) { return kPlain.find(c) == std::string_view::npos; }, '-');
  return "coverage-" + name + ".svg";
}

Status write_comparison(const std::filesystem::path& folder, std::span<const CampaignRun> runs,
                        std::span<const CampaignSummary> summaries) {
  SACCADE_CHECK(runs_csv(runs).write(folder / "runs.csv"));
  SACCADE_CHECK(views_csv(runs).write(folder / "views.csv"));
  SACCADE_CHECK(summary_csv(summaries).write(folder / "summary.csv"));
  std::string drawn;
  for (const CampaignSummary& summary : summaries) {  // those of one scene follow each other
    if (summary.scene == drawn) continue;
    drawn = summary.scene;
    SACCADE_CHECK(write_file_atomically(folder / picture_name(drawn), picture_of(drawn, runs, summaries)));
  }
  return {};
}

void print_comparison(std::ostream& out, std::span<const CampaignSummary> summaries,
                      std::span<const StrategyGap> gaps) {
  constexpr std::size_t kName{18};
  constexpr std::size_t kFigure{16};
  out << padded("scene", kName) << padded("strategy", kName) << padded("runs", 6) << padded("scan, %", kFigure)
      << padded("end, %", kFigure) << "views\n";
  for (const CampaignSummary& summary : summaries) {
    out << padded(summary.scene, kName) << padded(summary.strategy, kName)
        << padded(std::to_string(summary.coverage.n), 6) << padded(percent_text(summary.initial_coverage), kFigure)
        << padded(percent_text(summary.coverage), kFigure) << fixed(summary.views.mean, 1) << '\n';
  }
  for (const StrategyGap& gap : gaps) {
    if (gap.coverage.n == 0) continue;
    out << padded(gap.scene, kName) << gap.a << " - " << gap.b << ": " << percent_text(gap.coverage)
        << " points of coverage, by seed; ";
    if (gap.coverage.half_width) {
      out << "the intervals of the means are " << (gap.apart ? "apart\n" : "not apart\n");
    } else {
      out << "one seed has no interval\n";
    }
  }
}

json comparison_json(std::span<const CampaignSummary> summaries, std::span<const StrategyGap> gaps) {
  json rows = json::array();
  for (const CampaignSummary& summary : summaries) {
    rows.push_back({{"scene", summary.scene},
                    {"strategy", summary.strategy},
                    {"initial_coverage", estimate_json(summary.initial_coverage)},
                    {"coverage", estimate_json(summary.coverage)},
                    {"unknown_near_objects", estimate_json(summary.unknown_near_objects)},
                    {"f_score", estimate_json(summary.f_score)},
                    {"accuracy_m", estimate_json(summary.accuracy_m)},
                    {"views", estimate_json(summary.views)},
                    {"seconds", estimate_json(summary.seconds)}});
  }
  json differences = json::array();
  for (const StrategyGap& gap : gaps) {
    differences.push_back({{"scene", gap.scene},
                           {"a", gap.a},
                           {"b", gap.b},
                           {"coverage", estimate_json(gap.coverage)},
                           {"apart_initially", gap.apart_initially},
                           {"apart", gap.apart}});
  }
  return {{"summaries", std::move(rows)}, {"gaps", std::move(differences)}};
}

}  // namespace saccade::cli
