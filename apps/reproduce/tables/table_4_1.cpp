// SPDX-License-Identifier: Apache-2.0
// Table 4.1: the scenes of surfels.
#include "experiments/experiments.hpp"
#include "tables.hpp"
#include "text.hpp"
#include "thesis/surfel_figures.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;
using thesis::SurfelTrial;

std::string thousands(std::size_t count) { return fixed(static_cast<double>(count) / 1000.0, 0) + "k"; }

}  // namespace

Result<ReproducedTable> table_4_1(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                  const Progress& progress) {
  SACCADE_TRY(const DoneTrials trials, surfel_trials(options, executor, progress, experiments.surfels));
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

}  // namespace saccade::reproduce
