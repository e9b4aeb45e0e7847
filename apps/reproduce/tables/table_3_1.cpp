// SPDX-License-Identifier: Apache-2.0
// Table 3.1: seconds of each phase of five views, object-driven attention beside the standard method.
#include <algorithm>
#include <array>
#include <limits>

#include "experiments/experiments.hpp"
#include "saccade/core/statistics.hpp"
#include "tables.hpp"
#include "text.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;

/// A row of Table 3.1: seconds of five views, mean and standard deviation over the experiments.
struct TimedPhase {
  const char* name;
  const char* thesis_attention;
  const char* thesis_standard;
  double (*seconds)(const ViewRecord&);
};

const std::array<TimedPhase, 8> kTimedPhases{
    {{"segmentation + saliency", "46.1 ± 2.5", "-",
      [](const ViewRecord& view) {
        return phase_seconds(view, {Phase::segmentation, Phase::saliency});
      }},
     {"views generation", "2.1 ± 0.1", "2.1 ± 0.1",
      [](const ViewRecord& view) {
        return phase_seconds(view, {Phase::candidates, Phase::reachability});
      }},
     {"views evaluation", "26.0 ± 4.1", "288.5 ± 39.0",
      [](const ViewRecord& view) { return phase_seconds(view, {Phase::gain}); }},
     {"subtotal", "74.2 ± 4.8", "290.6 ± 39.0", next_best_view_s},
     {"planner map update", "46.0 ± 1.6", "44.6 ± 0.4",
      [](const ViewRecord& view) { return phase_seconds(view, {Phase::obstacles}); }},
     {"motion planning", "88.1 ± 17.9", "78.3 ± 13.8",
      [](const ViewRecord& view) { return phase_seconds(view, {Phase::planning}); }},
     {"robot motion", "110.5 ± 3.9", "108.5 ± 7.7", [](const ViewRecord& view) { return view.motion_s; }},
     {"total", "318.7 ± 19.1", "522.0 ± 42.0", [](const ViewRecord& view) {
        return view.motion_s + next_best_view_s(view) + phase_seconds(view, {Phase::obstacles, Phase::planning});
      }}}};

MeanEstimate seconds_of(const std::vector<RunRecord>& experiments, const TimedPhase& phase) {
  std::vector<double> sums;
  for (const RunRecord& experiment : experiments) {
    double sum = 0.0;
    for (const ViewRecord& view : experiment.views) sum += phase.seconds(view);
    sums.push_back(sum);
  }
  return estimate_mean(sums);
}

std::string seconds_text(const MeanEstimate& seconds) {
  return fixed(seconds.mean, 2) + " ± " + fixed(seconds.standard_deviation.value_or(0.0), 2);
}

/// "400 to 14000".
template <class Of>
std::string range_text(const std::vector<RunRecord>& experiments, Of of) {
  std::size_t least = std::numeric_limits<std::size_t>::max();
  std::size_t most = 0;
  for (const RunRecord& experiment : experiments) {
    for (const ViewRecord& view : experiment.views) {
      least = std::min(least, of(view));
      most = std::max(most, of(view));
    }
  }
  return most < least ? std::string{"none"} : std::to_string(least) + " to " + std::to_string(most);
}

}  // namespace

Result<ReproducedTable> table_3_1(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                  const Progress& progress) {
  SACCADE_CHECK(carry_out_explorations(options, executor, progress, experiments.explorations));
  const ExplorationExperiments& all = experiments.explorations;
  const std::vector<RunRecord> attention_runs = all.attention.runs();
  const std::vector<RunRecord> standard_runs = all.standard.runs();
  ReproducedTable table;
  table.caption = "Table 3.1: seconds of each phase of five views, mean and standard deviation of four experiments";
  table.columns = {"phase", "proposed, thesis", "attention", "standard, thesis", "standard"};
  json rows = json::array();
  for (const TimedPhase& phase : kTimedPhases) {
    const MeanEstimate attention = seconds_of(attention_runs, phase);
    const MeanEstimate standard = seconds_of(standard_runs, phase);
    table.rows.push_back(
        {phase.name, phase.thesis_attention, seconds_text(attention), phase.thesis_standard, seconds_text(standard)});
    rows.push_back({{"phase", phase.name}, {"attention_s", attention.mean}, {"standard_s", standard.mean}});
  }
  const auto candidates = [](const ViewRecord& view) { return view.candidates; };
  const auto evaluated = [](const ViewRecord& view) { return view.evaluated; };
  const double ratio =
      seconds_of(standard_runs, kTimedPhases[3]).mean / seconds_of(attention_runs, kTimedPhases[3]).mean;
  table.notes = {
      "Subtotal: the computation of the views. Standard over attention: thesis 3.9, here " + fixed(ratio, 1) + ".",
      "The thesis names \"thousands\" of candidates of the standard method, and 91,960 in one view. Here a view has " +
          range_text(standard_runs, candidates) + " candidates (40 per contour point), of which the arm can take " +
          range_text(standard_runs, evaluated) + ", and these alone are evaluated; attention evaluates " +
          range_text(attention_runs, evaluated) + " (the thesis: \"rarely more than two hundred\").",
      "Views generation: with the question which of them the arm can take, which the thesis asked afterwards. Robot "
      "motion: of the simulated arm, oscillation included. Fusion is in neither total."};
  add_exploration_notes(options, table);
  table.figures = experiments_json(all);
  table.figures["rows"] = std::move(rows);
  return table;
}

}  // namespace saccade::reproduce
