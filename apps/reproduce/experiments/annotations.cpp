// SPDX-License-Identifier: Apache-2.0
#include "experiments/annotations.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "saccade/core/statistics.hpp"
#include "text.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;
using thesis::MeanAndDeviation;
using thesis::Scenario;

/// How many actions an annotator has for a cloud.
struct Budget {
  const char* name;
  double actions;
  bool per_label;

  [[nodiscard]] std::size_t of(std::size_t labels) const {
    return static_cast<std::size_t>(per_label ? actions * static_cast<double>(labels) : actions);
  }
  [[nodiscard]] std::string text() const {
    return per_label ? fixed(actions, 1) + " per label" : std::to_string(of(0)) + " in all";
  }
};

std::array<Budget, 2> budgets_of(const Scenario& scenario) {
  const double actions = scenario.control_points.mean;
  return {{{"total", actions, false}, {"per_label", actions / static_cast<double>(thesis::kStudiedLabels), true}}};
}

std::size_t labels_in(const std::vector<std::uint32_t>& truth) {
  std::set<std::uint32_t> labels(truth.begin(), truth.end());
  labels.erase(0);
  return labels.size();
}

/// As many actions as either table needs.
std::size_t most_actions(std::size_t labels) {
  std::size_t most{0};
  for (const Scenario& scenario : {thesis::kTable4_5, thesis::kTable4_6}) {
    for (const Budget& budget : budgets_of(scenario)) most = std::max(most, budget.of(labels));
  }
  return most;
}

Result<AnnotationExperiments> carry_out(const TableOptions& options, const Executor& executor,
                                        const Progress& progress) {
  SACCADE_TRY(const LabelledClouds clouds, LabelledClouds::open(options));
  AnnotationExperiments experiments{clouds.about(), {}};
  cli::ProgressBar quiet{true};
  cli::AnnotateProgress silent{quiet, false};
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    progress.report("annotating clouds", i * kAnnotators.size(), clouds.size() * kAnnotators.size());
    SACCADE_TRY(LabelledCloud cloud, clouds.load(i, executor));
    AnnotationExperiment experiment{std::move(cloud), {}};
    cli::AnnotateOptions simulation;
    simulation.background_is_none = true;
    simulation.actions = most_actions(labels_in(experiment.cloud.truth));
    for (std::size_t a = 0; a < kAnnotators.size(); ++a) {
      if (progress.cancelled()) return Error{Errc::cancelled, "cancelled", "annotating " + experiment.name()};
      progress.report("annotating clouds", i * kAnnotators.size() + a, clouds.size() * kAnnotators.size());
      simulation.method = kAnnotators.at(a).by;
      simulation.graph = kAnnotators.at(a).graph;
      SACCADE_TRY(experiment.annotations.at(a),
                  simulate_annotation(simulation, experiment.cloud.job, experiment.cloud.points, experiment.cloud.truth,
                                      executor, silent));
    }
    experiments.clouds.push_back(std::move(experiment));
  }
  return experiments;
}

/// Where an annotator is when its actions are spent or nothing is wrong any more.
struct StudyResult {
  std::size_t actions{0};
  cli::AnnotationStep step;
  double errors_per_100k{0.0};
};

StudyResult outcome_of(const cli::SimulatedAnnotation& annotation, const Budget& budget) {
  StudyResult outcome;
  outcome.actions = std::min(budget.of(annotation.objects), annotation.clicks.size());
  if (outcome.actions == 0) return outcome;
  outcome.step = annotation.clicks[outcome.actions - 1];
  outcome.errors_per_100k = 1e5 * static_cast<double>(outcome.step.errors) / static_cast<double>(annotation.points);
  return outcome;
}

/// Over clouds; the deviation of one is 0.
MeanAndDeviation mean_of(const std::vector<double>& values) {
  const MeanEstimate estimate = estimate_mean(values);
  return {estimate.mean, estimate.standard_deviation.value_or(0.0)};
}

std::string text_of(const MeanAndDeviation& value, int decimals) {
  return fixed(value.mean, decimals) + " ± " + fixed(value.deviation, decimals);
}

json json_of(const MeanAndDeviation& value) { return {{"mean", value.mean}, {"deviation", value.deviation}}; }

void add_thesis(const Scenario& scenario, ReproducedTable& table, json& rows) {
  const auto add = [&](const char* method, const thesis::StudiedMethod& studied, bool clicks) {
    const double per_100k = 1e5 * studied.errors.mean / static_cast<double>(scenario.points);
    table.rows.push_back({"10 people (thesis)", method, clicks ? "Table 4.4" : "–", text_of(studied.minutes, 1),
                          text_of(studied.undos_per_minute, 2),
                          clicks ? text_of(scenario.control_points, 1) : "not said", text_of(studied.errors, 0),
                          fixed(per_100k, 0), fixed(1e-3 * per_100k, 2) + " %", "–"});
    rows.push_back({{"annotator", "people"},
                    {"method", method},
                    {"minutes", json_of(studied.minutes)},
                    {"undos_per_minute", json_of(studied.undos_per_minute)},
                    {"actions", clicks ? json_of(scenario.control_points) : json(nullptr)},
                    {"errors", json_of(studied.errors)},
                    {"errors_per_100k", per_100k}});
  };
  add("control points", scenario.by_control_points, true);
  add("rectangles", scenario.by_rectangles, false);
}

void add_row(const AnnotationExperiments& experiments, std::size_t annotator, const Budget& budget,
             ReproducedTable& table, json& rows) {
  std::vector<double> actions, errors, per_100k, iou_mean;
  json clouds = json::array();
  for (const AnnotationExperiment& experiment : experiments.clouds) {
    const cli::SimulatedAnnotation& annotation = experiment.annotations.at(annotator);
    const StudyResult outcome = outcome_of(annotation, budget);
    actions.push_back(static_cast<double>(outcome.actions));
    errors.push_back(static_cast<double>(outcome.step.errors));
    per_100k.push_back(outcome.errors_per_100k);
    iou_mean.push_back(outcome.step.iou_mean);
    clouds.push_back({{"cloud", experiment.name()},
                      {"points", annotation.points},
                      {"labels", annotation.objects},
                      {"actions", outcome.actions},
                      {"errors", outcome.step.errors},
                      {"iou_mean", outcome.step.iou_mean}});
  }
  const Annotator& by = kAnnotators.at(annotator);
  const MeanAndDeviation mean_per_100k = mean_of(per_100k);
  const MeanAndDeviation mean_iou = mean_of(iou_mean);
  table.rows.push_back({"simulated, " + budget.text(), by.method, by.weights, "–", "–", text_of(mean_of(actions), 1),
                        text_of(mean_of(errors), 0), text_of(mean_per_100k, 0),
                        fixed(1e-3 * mean_per_100k.mean, 2) + " %", fixed(mean_iou.mean, 3)});
  rows.push_back({{"annotator", "simulated"},
                  {"method", by.method},
                  {"weights", by.weights},
                  {"budget", budget.name},
                  {"actions", json_of(mean_of(actions))},
                  {"errors", json_of(mean_of(errors))},
                  {"errors_per_100k", json_of(mean_per_100k)},
                  {"iou_mean", json_of(mean_iou)},
                  {"clouds", std::move(clouds)}});
}

std::vector<std::string> notes_of(const Scenario& scenario, const AnnotationExperiments& experiments) {
  const std::array<Budget, 2> budgets = budgets_of(scenario);
  return {
      "No person annotates here: simulated annotators who know the truth stand for the thesis' ten people. With "
      "control points they click at the centre of the largest region that is wrong; rectangles they draw around it, in "
      "the best of six views, on the surface or through it. The best of all possible rectangles no person finds: they "
      "show "
      "what rectangles could do. Time and undos are people's.",
      experiments.about,
      "Actions: as many as people placed control points (" + budgets[0].text() + "), and as many per label (" +
          std::to_string(thesis::kStudiedLabels) + " in the thesis: four objects and the background; " +
          budgets[1].text() +
          "), or until no action makes it better. A rectangle counts as a click does; how many "
          "people drew is not said.",
      "Errors are points with another label than the truth has; where most points belong, no label counts as theirs "
      "(the thesis' background). ±: over people in the thesis, over clouds here. The thesis' own two ground truths "
      "differ in " +
          std::to_string(scenario.truths_differ) + " of " + std::to_string(scenario.points) + " points.",
      "Table 4.4's weights were chosen on fused clouds; single frames of a depth camera are not smooth enough for "
      "them, "
      "above all not for Ω_max = 1 (docs/decisions/0014-annotation-weights.md). \"As printed\" and with these weights, "
      "clicks spread as in Algorithm 8; ours stop at strong borders (docs/design/annotation-leaks.md)."};
}

}  // namespace

Status carry_out_annotations(const TableOptions& options, const Executor& executor, const Progress& progress,
                             std::optional<AnnotationExperiments>& all) {
  if (all) return {};
  SACCADE_TRY(all, carry_out(options, executor, progress));
  return {};
}

Result<ReproducedTable> user_study(const Scenario& scenario, const std::string& number, const TableOptions& options,
                                   const Executor& executor, const Progress& progress,
                                   std::optional<AnnotationExperiments>& all) {
  SACCADE_CHECK(carry_out_annotations(options, executor, progress, all));
  const AnnotationExperiments& experiments = *all;
  ReproducedTable table;
  table.caption = "Table " + number + ": annotation errors of scenario " + std::to_string(scenario.number);
  table.columns = {"annotator", "method",       "weights",     "time, min",   "undos per min",
                   "actions",   "points wrong", "per 100,000", "share wrong", "mean IoU"};
  json rows = json::array();
  add_thesis(scenario, table, rows);
  for (const Budget& budget : budgets_of(scenario)) {
    for (std::size_t a = 0; a < kAnnotators.size(); ++a) add_row(experiments, a, budget, table, rows);
  }
  table.notes = notes_of(scenario, experiments);
  table.figures = {{"clouds", experiments.clouds.size()}, {"rows", std::move(rows)}};
  return table;
}

}  // namespace saccade::reproduce
