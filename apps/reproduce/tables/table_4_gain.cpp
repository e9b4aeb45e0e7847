// SPDX-License-Identifier: Apache-2.0
// Table 4.gain, which the thesis does not have: what automatic gain costs enhanced surfels (§4.1.3), and how much of it
// exposure compensation wins back.
#include <algorithm>

#include "experiments/surfel_trials.hpp"
#include "tables.hpp"
#include "text.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;
using thesis::SurfelColors;
using thesis::SurfelTrial;

constexpr std::array<std::string_view, 2> kScenesWithGain{"magazines-1", "magazines-2"};
constexpr int kGainDecimals{3};
/// Least difference that shows in the printed decimals; a smaller one does not count as a loss.
constexpr double kLeastLoss{0.0005};

/// One figure of a scene, without gain, with it, and with the remedy.
struct GainFigure {
  std::string name;
  std::array<double, 3> values{};
  bool less_is_better{false};

  [[nodiscard]] double loss() const { return less_is_better ? values[1] - values[0] : values[0] - values[1]; }
  /// Share of the loss that came back; none without a loss.
  [[nodiscard]] std::optional<double> won_back() const {
    if (loss() < kLeastLoss) return std::nullopt;
    return (less_is_better ? values[1] - values[2] : values[2] - values[1]) / loss();
  }
};

double most_recall(const ScoreCurve& curve) {
  double most{0.0};
  for (const CurvePoint& point : curve.points) most = std::max(most, point.score.recall().value_or(0.0));
  return most;
}

double precision_at(const ScoreCurve& curve, double recall) {
  double most{0.0};
  for (const CurvePoint& point : curve.points) {
    if (point.score.recall().value_or(0.0) >= recall) most = std::max(most, point.score.precision().value_or(0.0));
  }
  return most;
}

using GainCurves = std::array<const ScoreCurve*, 3>;

GainCurves curves_of(const std::array<SurfelTrial, 3>& trials, bool by_flood_fill, SurfelColors colors) {
  GainCurves curves{};
  for (std::size_t i = 0; i < curves.size(); ++i) curves[i] = &trials[i].curve(by_flood_fill, colors);
  return curves;
}

/// @param recall  at which precision is asked for.
std::vector<GainFigure> measures_of(const GainCurves& curves, double recall) {
  GainFigure area{"area below the curve"};
  GainFigure precision{"precision at recall " + fixed(recall, kGainDecimals)};
  GainFigure f{"greatest F"};
  GainFigure bce{"least BCE", {}, true};
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const std::optional<CurvePoint> best_f = curves[i]->best_f();
    const std::optional<CurvePoint> least_bce = curves[i]->least_bce();
    area.values[i] = curves[i]->area();
    precision.values[i] = precision_at(*curves[i], recall);
    f.values[i] = best_f ? best_f->score.f().value_or(0.0) : 0.0;
    bce.values[i] = least_bce ? least_bce->score.bce : 1.0;
  }
  return {area, precision, f, bce};
}

/// Without gain, with it, and with the remedy: the same way, seed and noise.
Result<std::array<SurfelTrial, 3>> trials_of(std::string_view scene, const TableOptions& options,
                                             const Executor& executor, const Progress& progress) {
  std::array<SurfelTrial, 3> trials;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    thesis::SurfelTrialConfig config;
    config.frames = options.frames;
    config.image_width_px = options.image_width_px;
    config.placements = options.placements;
    config.seed = options.seed;
    config.automatic_gain = i > 0;
    config.exposure_compensation = i > 1;
    SACCADE_TRY(trials[i], carry_out_surfel_trial(scene, config, executor, progress));
  }
  return trials;
}

json gains_json(const SurfelTrial& trial) {
  const auto [least, most] = std::minmax_element(trial.true_gains.begin(), trial.true_gains.end());
  double worst{0.0};
  for (std::size_t i = 0; i < trial.true_gains.size(); ++i) {
    worst = std::max(worst, std::abs(trial.found_gains[i] / trial.true_gains[i] - 1.0));
  }
  return {{"min", *least}, {"max", *most}, {"worst_error", worst}};
}

}  // namespace

Result<ReproducedTable> table_4_gain(const TableOptions& options, Experiments& /*experiments*/,
                                     const Executor& executor, const Progress& progress) {
  ReproducedTable table;
  table.caption = "Table 4.gain: automatic gain and enhanced surfels, with and without exposure compensation";
  table.columns = {"scene", "algorithm", "figure", "gain off", "on", "on, compensated", "loss won back"};
  if (!options.surfel_scene.empty() &&
      std::find(kScenesWithGain.begin(), kScenesWithGain.end(), options.surfel_scene) == kScenesWithGain.end()) {
    return Error{Errc::invalid_argument, "Table 4.gain is of magazines-1 and magazines-2, whose camera has gain",
                 options.surfel_scene};
  }
  json rows = json::array();
  for (const std::string_view scene : kScenesWithGain) {
    if (!options.surfel_scene.empty() && options.surfel_scene != scene) continue;
    const auto done = trials_of(scene, options, executor, progress);
    if (!done && (done.error().code != Errc::cancelled || rows.empty())) return done.error();
    if (!done) {
      mark_missing({std::string{scene}}, table);
      break;
    }
    const std::array<SurfelTrial, 3>& trials = *done;
    json row{{"scene", scene}, {"frames", trials[0].frames}, {"gains", gains_json(trials[2])}};
    for (const bool by_flood_fill : {true, false}) {
      const GainCurves modes = curves_of(trials, by_flood_fill, SurfelColors::modes);
      const double recall = std::min({most_recall(*modes[0]), most_recall(*modes[1]), most_recall(*modes[2])});
      const std::vector<GainFigure> enhanced = measures_of(modes, recall);
      const std::vector<GainFigure> not_enhanced =
          measures_of(curves_of(trials, by_flood_fill, SurfelColors::average), recall);
      json figures = json::array();
      for (std::size_t k = 0; k < enhanced.size(); ++k) {
        const std::optional<double> won = enhanced[k].won_back();
        const auto values_json = [](const GainFigure& figure) {
          return json{{"off", figure.values[0]}, {"on", figure.values[1]}, {"compensated", figure.values[2]}};
        };
        std::vector<std::string> cells{std::string{scene}, by_flood_fill ? "flood fill" : "SV-LCCP", enhanced[k].name};
        for (std::size_t i = 0; i < trials.size(); ++i) {
          cells.push_back(fixed(not_enhanced[k].values[i], kGainDecimals) + " → " +
                          fixed(enhanced[k].values[i], kGainDecimals));
        }
        cells.push_back(won ? fixed(100.0 * *won, 0) + " %" : "no loss");
        table.rows.push_back(std::move(cells));
        json figure = values_json(enhanced[k]);
        figure.update({{"figure", enhanced[k].name},
                       {"not_enhanced", values_json(not_enhanced[k])},
                       {"won_back", won ? json(*won) : json(nullptr)}});
        figures.push_back(std::move(figure));
      }
      row[by_flood_fill ? "flood_fill" : "sv_lccp"] = std::move(figures);
    }
    table.notes.push_back(std::string{scene} + ": gains from " + fixed(row["gains"]["min"].get<double>(), 2) + " to " +
                          fixed(row["gains"]["max"].get<double>(), 2) +
                          " of the first frame's, found with errors of at most " +
                          fixed(100.0 * row["gains"]["worst_error"].get<double>(), 1) + " %.");
    rows.push_back(std::move(row));
  }
  table.notes.push_back(
      "The thesis has no such table: it says that automatic gain lowers precision at the highest recall (§4.1.3). "
      "Scenes are rendered, each time with the same way and noise. The recall is the highest that all three reach.");
  table.notes.push_back("Figures are not enhanced → enhanced; the loss, and what was won back, are of the enhanced.");
  if (options.frames > 0) table.notes.push_back("Only " + std::to_string(options.frames) + " frames (--frames).");
  if (options.image_width_px > 0) {
    table.notes.push_back("Images are " + std::to_string(options.image_width_px) + " pixels wide (--image-width).");
  }
  table.figures = {{"rows", std::move(rows)}};
  return table;
}

}  // namespace saccade::reproduce
