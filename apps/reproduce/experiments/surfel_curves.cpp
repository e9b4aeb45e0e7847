// SPDX-License-Identifier: Apache-2.0
#include "experiments/surfel_curves.hpp"

#include "saccade/report/plot.hpp"
#include "text.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;
using thesis::SurfelColors;
using thesis::SurfelTrial;

constexpr int kCurveDecimals{3};

PlotSeries series_of(const std::string& name, const ScoreCurve& curve) {
  PlotSeries series{name, {}, {}};
  for (const CurvePoint& point : curve.points) {
    if (!point.score.recall() || !point.score.precision()) continue;
    series.x.push_back(*point.score.recall());
    series.y.push_back(*point.score.precision());
  }
  return series;
}

}  // namespace

Result<ReproducedTable> reproduce_curves(const TableOptions& options, const Executor& executor,
                                         const Progress& progress, SurfelExperiments& all, bool by_flood_fill) {
  SACCADE_TRY(const DoneTrials trials, surfel_trials(options, executor, progress, all));
  const std::string algorithm = by_flood_fill ? "flood fill" : "supervoxels and LCCP";
  ReproducedTable table;
  table.caption = std::string{by_flood_fill ? "Fig. 4.10" : "Fig. 4.11"} + ": boundary precision over recall, " +
                  algorithm + ", not enhanced → enhanced";
  table.columns = {"scene",           "area below the curve", "with true colours", "greatest F", "with true colours",
                   "precision there", "recall there"};
  json rows = json::array();
  const std::string plot_name = by_flood_fill ? "fig-4-10-" : "fig-4-11-";
  for (const auto& [scene, done] : trials.done) {
    const SurfelTrial& trial = *done;
    const ScoreCurve& average = trial.curve(by_flood_fill, SurfelColors::average);
    const ScoreCurve& modes = trial.curve(by_flood_fill, SurfelColors::modes);
    const ScoreCurve& truth = trial.curve(by_flood_fill, SurfelColors::truth);
    const auto both = [&](const auto& figure) {
      const auto text = [&](const ScoreCurve& curve) {
        const std::optional<double> value = figure(curve);
        return value ? fixed(*value, kCurveDecimals) : std::string{"–"};
      };
      return text(average) + " → " + text(modes);
    };
    const auto at_best = [](const ScoreCurve& curve, auto&& value) -> std::optional<double> {
      const std::optional<CurvePoint> best = curve.best_f();
      return best ? value(best->score) : std::nullopt;
    };
    const auto best_f = truth.best_f();
    table.rows.push_back(
        {trial.scene, both([](const ScoreCurve& curve) { return std::optional{curve.area()}; }),
         fixed(truth.area(), kCurveDecimals),
         both([&](const ScoreCurve& c) { return at_best(c, [](const SegmentationScore& s) { return s.f(); }); }),
         fixed(best_f ? best_f->score.f().value_or(0.0) : 0.0, kCurveDecimals), both([&](const ScoreCurve& c) {
           return at_best(c, [](const SegmentationScore& s) { return s.precision(); });
         }),
         both([&](const ScoreCurve& c) { return at_best(c, [](const SegmentationScore& s) { return s.recall(); }); })});
    rows.push_back({{"scene", trial.scene},
                    {"not_enhanced", json_of(average)},
                    {"enhanced", json_of(modes)},
                    {"true_colors", json_of(truth)}});
    Plot plot;
    plot.title = trial.scene + ", " + algorithm;
    plot.x_label = "boundary recall";
    plot.y_label = "boundary precision";
    plot.x_range = {0.0, 1.0};
    plot.y_range = {0.0, 1.0};
    plot.series = {series_of("not enhanced", average), series_of("enhanced", modes)};
    table.plots.push_back({plot_name + trial.scene + ".svg", plot_svg(plot)});
  }
  table.notes = {
      "The thesis shows curves without figures. Thresholds go from 0.0005 to 0.5; the area is that under the "
      "greatest precision at each recall or beyond it.",
      "With true colours: places that are not enhanced, and every surfel in the one colour of the thing that it is on. "
      "Where that is less than without enhancement, the figure rewards blur."};
  add_surfel_notes(options, !by_flood_fill, table);
  mark_missing(trials.missing, table);
  table.figures = {{"rows", std::move(rows)}};
  return table;
}

}  // namespace saccade::reproduce
