// SPDX-License-Identifier: Apache-2.0
// Tables 4.1 to 4.3 and Figs. 4.10 and 4.11: surfels with and without the mode filter, and how well they are segmented
// (thesis §4.1.3), on rendered scenes.
#include <limits>
#include <sstream>

#include "json_output.hpp"
#include "saccade/report/plot.hpp"
#include "saccade/surfel/mode_filter.hpp"
#include "saccade/surfel/surfel_fusion.hpp"
#include "summary.hpp"
#include "tables/surfel_experiments.hpp"
#include "thesis/surfel_figures.hpp"

namespace saccade::cli {

using nlohmann::json;
using thesis::SurfelColors;
using thesis::SurfelTrial;

Result<std::shared_ptr<const SurfelTrial>> surfel_trial(const ReproduceOptions& options, std::size_t scene,
                                                        const Executor& executor, const Progress& progress) {
  if (!options.surfels) options.surfels = std::make_shared<SurfelExperiments>();
  std::shared_ptr<const SurfelTrial>& trial = options.surfels->trials.at(scene);
  if (!trial) {
    thesis::SurfelTrialConfig config;
    config.frames = options.frames;
    config.image_width_px = options.image_width_px;
    config.placements = options.placements;
    if (options.as_printed) {
      config.mode_filter.choice_sigmas = 0.0;
      config.places_of_modes = true;
      config.mode_filter.max_depth_change_m = std::numeric_limits<double>::infinity();
    }
    config.seed = options.seed;
    SACCADE_TRY(SurfelTrial made, carry_out_surfel_trial(kSurfelScenes.at(scene), config, executor, progress));
    trial = std::make_shared<const SurfelTrial>(std::move(made));
  }
  return trial;
}

void add_surfel_notes(const ReproduceOptions& options, bool is_of_sv_lccp, ReproducedTable& table) {
  if (is_of_sv_lccp) {
    table.notes.push_back("SV-LCCP is done with the grid of seeds in " + std::to_string(options.placements) +
                          (options.placements == 1 ? " place." : " places, and the figures are taken together."));
  }
  table.notes.push_back(
      "Here scenes are rendered, with noise of depth, colours and poses (docs/surfel-scenes.md), and truth comes from "
      "the renderer; the thesis' were recorded and annotated by hand. Figures compare in kind.");
  if (options.as_printed) {
    table.notes.push_back("The mode filter is Algorithm 6 with eq. 4.11 as printed (--as-printed, decision 18).");
  }
  if (options.frames > 0) {
    table.notes.push_back("Only " + std::to_string(options.frames) +
                          " frames of each (--frames), which is quicker, but not what the thesis did.");
  }
  if (options.image_width_px > 0) {
    table.notes.push_back("Images are " + std::to_string(options.image_width_px) +
                          " pixels wide (--image-width), which is quicker, but not what the thesis did.");
  }
}

void mark_missing(const std::vector<std::string>& scenes, ReproducedTable& table) {
  if (scenes.empty()) return;
  table.complete = false;
  table.notes.push_back("Interrupted: without " + joined(scenes) + ".");
}

namespace {

constexpr int kErrorDecimals{3};

/// Of kSurfelScenes.
std::vector<std::size_t> chosen_scenes(const ReproduceOptions& options) {
  std::vector<std::size_t> chosen;
  for (std::size_t scene = 0; scene < kSurfelScenes.size(); ++scene) {
    if (options.surfel_scene.empty() || options.surfel_scene == kSurfelScenes.at(scene)) chosen.push_back(scene);
  }
  return chosen;
}

struct DoneTrial {
  std::size_t scene{0};  ///< of kSurfelScenes
  std::shared_ptr<const SurfelTrial> trial;
};

/// The trials of the chosen scenes; after an interruption those that were done, if any, and what is missing.
struct DoneTrials {
  std::vector<DoneTrial> done;
  std::vector<std::string> missing;
};

Result<DoneTrials> trials_of(const ReproduceOptions& options, const Executor& executor, const Progress& progress) {
  DoneTrials trials;
  Status interruption;
  for (const std::size_t scene : chosen_scenes(options)) {
    const auto trial = surfel_trial(options, scene, executor, progress);
    if (trial) {
      trials.done.push_back({scene, *trial});
    } else if (trial.error().code == Errc::cancelled) {
      trials.missing.emplace_back(kSurfelScenes.at(scene));
      interruption = trial.error();
    } else {
      return trial.error();
    }
  }
  if (trials.done.empty()) return interruption.error();
  return trials;
}

std::string thousands(std::size_t count) { return fixed(static_cast<double>(count) / 1000.0, 0) + "k"; }

std::string least(const ScoreCurve& curve) {
  const std::optional<CurvePoint> best = curve.least_bce();
  return best ? fixed(best->score.bce, kErrorDecimals) : "–";
}

json json_of(const ScoreCurve& curve) {
  json points = json::array();
  for (const CurvePoint& point : curve.points) {
    points.push_back({{"threshold", point.threshold},
                      {"segments", point.segments},
                      {"precision", optional_json(point.score.precision())},
                      {"recall", optional_json(point.score.recall())},
                      {"f", optional_json(point.score.f())},
                      {"bce", point.score.bce}});
  }
  const std::optional<CurvePoint> best_f = curve.best_f();
  const std::optional<CurvePoint> least_bce = curve.least_bce();
  return {{"points", std::move(points)},
          {"area", curve.area()},
          {"best_f", best_f ? optional_json(best_f->score.f()) : json(nullptr)},
          {"least_bce", least_bce ? json(least_bce->score.bce) : json(nullptr)}};
}

PlotSeries series_of(const std::string& name, const ScoreCurve& curve) {
  PlotSeries series{name, {}, {}};
  for (const CurvePoint& point : curve.points) {
    if (!point.score.recall() || !point.score.precision()) continue;
    series.x.push_back(*point.score.recall());
    series.y.push_back(*point.score.precision());
  }
  return series;
}

/// Precision over recall, a plot per scene.
Result<ReproducedTable> reproduce_curves(const ReproduceOptions& options, const Executor& executor,
                                         const Progress& progress, bool by_flood_fill) {
  SACCADE_TRY(const DoneTrials trials, trials_of(options, executor, progress));
  const std::string algorithm = by_flood_fill ? "flood fill" : "supervoxels and LCCP";
  ReproducedTable table;
  table.caption = std::string{by_flood_fill ? "Fig. 4.10" : "Fig. 4.11"} + ": boundary precision over recall, " +
                  algorithm + ", not enhanced → enhanced";
  table.columns = {"scene",           "area below the curve", "with true colours", "greatest F", "with true colours",
                   "precision there", "recall there"};
  json rows = json::array();
  const std::size_t first_plot = by_flood_fill ? kFirstSurfelPlot : kFirstSurfelPlot + kSurfelScenes.size();
  for (const auto& [i, done] : trials.done) {
    const SurfelTrial& trial = *done;
    const ScoreCurve& average = trial.curve(by_flood_fill, SurfelColors::average);
    const ScoreCurve& modes = trial.curve(by_flood_fill, SurfelColors::modes);
    const ScoreCurve& truth = trial.curve(by_flood_fill, SurfelColors::truth);
    const auto both = [&](const auto& figure) {
      const auto text = [&](const ScoreCurve& curve) {
        const std::optional<double> value = figure(curve);
        return value ? fixed(*value, kErrorDecimals) : std::string{"–"};
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
         fixed(truth.area(), kErrorDecimals),
         both([&](const ScoreCurve& c) { return at_best(c, [](const SegmentationScore& s) { return s.f(); }); }),
         fixed(best_f ? best_f->score.f().value_or(0.0) : 0.0, kErrorDecimals), both([&](const ScoreCurve& c) {
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
    table.plots.push_back({kTablePlotFiles[first_plot + i], plot_svg(plot)});
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

}  // namespace

Result<ReproducedTable> reproduce_table_4_1(const ReproduceOptions& options, const Executor& executor,
                                            const Progress& progress) {
  SACCADE_TRY(const DoneTrials trials, trials_of(options, executor, progress));
  ReproducedTable table;
  table.caption = "Table 4.1: the scenes, thesis → here";
  table.columns = {"scene", "frames", "points", "true labels", "ms per frame, here"};
  json rows = json::array();
  for (const auto& [i, done] : trials.done) {
    const SurfelTrial& trial = *done;
    const thesis::SurfelDataset& printed = thesis::kTable4_1.at(i);
    table.rows.push_back({trial.scene, std::to_string(printed.frames) + " → " + std::to_string(trial.frames),
                          thousands(printed.points) + " → " + thousands(trial.surfels),
                          std::to_string(printed.labels) + " → " + std::to_string(trial.segments),
                          fixed(trial.ms_per_frame, 1)});
    rows.push_back({{"scene", trial.scene},
                    {"thesis", {{"frames", printed.frames}, {"points", printed.points}, {"labels", printed.labels}}},
                    {"frames", trial.frames},
                    {"points", trial.surfels},
                    {"labels", trial.segments},
                    {"ms_per_frame", trial.ms_per_frame}});
  }
  table.notes = {
      "Labels are counted after parts that do not touch were split. Milliseconds are those of surfels and "
      "mode filter together, median; the thesis' took 100 ms on eight threads."};
  add_surfel_notes(options, false, table);
  mark_missing(trials.missing, table);
  table.figures = {{"rows", std::move(rows)}};
  return table;
}

Result<ReproducedTable> reproduce_table_4_2(const ReproduceOptions& /*options*/, const Executor& /*executor*/,
                                            const Progress& /*progress*/) {
  ReproducedTable table;
  table.caption = "Table 4.2: parameters of surfels, mode filter and evaluation";
  table.columns = {"parameter", "thesis", "default here"};
  json rows = json::array();
  const auto number_text = [](double value) {
    std::ostringstream text;
    text << value;
    return text.str();
  };
  const auto add = [&](const char* parameter, double printed, double ours) {
    table.rows.push_back({parameter, number_text(printed), number_text(ours)});
    rows.push_back({{"parameter", parameter}, {"thesis", printed}, {"here", ours}});
  };
  const ModeFilterConfig filter;
  const FloodFillConfig filling;
  add("σ_c", thesis::kColorSigma, filter.guided.color_sigma);
  add("σ_d, m", thesis::kDepthSigma_m, filter.guided.depth_sigma_m);
  add("K", thesis::kColorSigmas, filter.color_sigmas);
  add("R_m, pixels", thesis::kMeanRadius_px, filter.guided.radius_px);
  add("M_max", thesis::kMaxModes, filter.max_modes);
  add("σ_img", thesis::kImageSigma, SurfelFusionConfig{}.image_sigma);
  add("T_eval, m", thesis::kEvaluation_m, BoundaryMatchingConfig{}.tolerance_m);
  add("α_n of flood fill", thesis::kNormalWeight, filling.normal_weight);
  add("α_c of flood fill", thesis::kColorWeight, filling.color_weight);
  table.notes = {
      "Supervoxels have the thesis' parameters in Tables 4.3 and Fig. 4.11 (V_lccp 1 cm, S_lccp 5 cm, α_p 0.1, "
      "α_n 0.5, α_c 1). σ_img is 0.1 in the scene with vignetting, the third, as in the thesis."};
  table.figures = {{"rows", std::move(rows)}};
  return table;
}

Result<ReproducedTable> reproduce_table_4_3(const ReproduceOptions& options, const Executor& executor,
                                            const Progress& progress) {
  SACCADE_TRY(const DoneTrials trials, trials_of(options, executor, progress));
  ReproducedTable table;
  table.caption = "Table 4.3: least bidirectional consistency error, not enhanced → enhanced";
  table.columns = {"scene", "flood fill, thesis", "here", "SV-LCCP, thesis", "here"};
  json rows = json::array();
  for (const auto& [i, done] : trials.done) {
    const SurfelTrial& trial = *done;
    const thesis::LeastErrors& printed = thesis::kTable4_3.at(i);
    const auto thesis_pair = [](double average, double modes) {
      return fixed(average, kErrorDecimals) + " → " + fixed(modes, kErrorDecimals);
    };
    const auto pair = [&](bool by_flood_fill) {
      return least(trial.curve(by_flood_fill, SurfelColors::average)) + " → " +
             least(trial.curve(by_flood_fill, SurfelColors::modes));
    };
    table.rows.push_back({trial.scene, thesis_pair(printed.flood_fill, printed.flood_fill_enhanced), pair(true),
                          thesis_pair(printed.sv_lccp, printed.sv_lccp_enhanced), pair(false)});
    rows.push_back({{"scene", trial.scene},
                    {"thesis",
                     {{"flood_fill", {printed.flood_fill, printed.flood_fill_enhanced}},
                      {"sv_lccp", {printed.sv_lccp, printed.sv_lccp_enhanced}}}},
                    {"flood_fill",
                     {{"not_enhanced", json_of(trial.curve(true, SurfelColors::average))},
                      {"enhanced", json_of(trial.curve(true, SurfelColors::modes))}}},
                    {"sv_lccp",
                     {{"not_enhanced", json_of(trial.curve(false, SurfelColors::average))},
                      {"enhanced", json_of(trial.curve(false, SurfelColors::modes))}}}});
  }
  add_surfel_notes(options, true, table);
  mark_missing(trials.missing, table);
  table.figures = {{"rows", std::move(rows)}};
  return table;
}

Result<ReproducedTable> reproduce_figure_4_10(const ReproduceOptions& options, const Executor& executor,
                                              const Progress& progress) {
  return reproduce_curves(options, executor, progress, true);
}

Result<ReproducedTable> reproduce_figure_4_11(const ReproduceOptions& options, const Executor& executor,
                                              const Progress& progress) {
  return reproduce_curves(options, executor, progress, false);
}

}  // namespace saccade::cli
