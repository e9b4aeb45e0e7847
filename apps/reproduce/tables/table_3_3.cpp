// SPDX-License-Identifier: Apache-2.0
// Table 3.3: which views point towards the objects.
#include <array>

#include "experiments/experiments.hpp"
#include "tables.hpp"
#include "text.hpp"

namespace saccade::reproduce {
namespace {

std::string mark(const std::vector<ViewRecord>& views, std::size_t k, std::optional<bool> ViewRecord::*points) {
  if (k >= views.size()) return "-";
  return (views[k].*points).value_or(false) ? "✓" : "×";
}

}  // namespace

Result<ReproducedTable> table_3_3(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                  const Progress& progress) {
  constexpr std::array<const char*, 8> kThesis{"✓✓✓✓×", "✓✓✓××", "✓✓✓××", "✓✓✓✓✓", "×✓×✓×", "✓×××✓", "××✓×✓", "××✓××"};
  SACCADE_CHECK(carry_out_explorations(options, executor, progress, experiments.explorations));
  const ExplorationExperiments& all = experiments.explorations;
  ReproducedTable table;
  table.caption = "Table 3.3: views that point towards the objects (✓) or not (×)";
  table.columns = {"method", "experiment", "thesis", "by the axis", "by the newly known voxels"};
  const auto marks = [](const RunRecord& experiment, std::optional<bool> ViewRecord::*looks) {
    std::string text;
    for (std::size_t k = 0; k < kExplorationViews; ++k) text += mark(experiment.views, k, looks);
    return text;
  };
  std::size_t row = 0;
  std::array<std::array<std::size_t, 2>, 2> counts{};
  for (const bool attention : {true, false}) {
    const std::vector<RunRecord> runs = (attention ? all.attention : all.standard).runs();
    for (std::size_t i = 0; i < runs.size(); ++i) {
      table.rows.push_back({attention ? "attention" : "standard", std::to_string(i + 1) + ", " + kTabletops.at(i),
                            kThesis.at(row++), marks(runs[i], &ViewRecord::looks_at_object),
                            marks(runs[i], &ViewRecord::reveals_object)});
      for (const ViewRecord& view : runs[i].views) {
        counts[attention ? 0 : 1][0] += view.looks_at_object.value_or(false) ? 1 : 0;
        counts[attention ? 0 : 1][1] += view.reveals_object.value_or(false) ? 1 : 0;
      }
    }
  }
  const auto of_20 = [](std::size_t count) { return std::to_string(count) + " of 20"; };
  table.notes = {
      "Attention: thesis 15 of 20, by the axis " + of_20(counts[0][0]) + ", by the newly known voxels " +
          of_20(counts[0][1]) + "; standard: thesis 7 of 20, " + of_20(counts[1][0]) + " and " + of_20(counts[1][1]) +
          ".",
      "By the axis: it comes within 5 cm of an object before it meets anything. By the newly known voxels: at least a "
      "quarter "
      "of the voxels lie within 5 cm of an object. The thesis does not say how it judged; by the second rule hardly a "
      "first view points at an object, since it also shows what was hidden behind (docs/reference/metrics.md)."};
  add_exploration_notes(options, table);
  table.figures = experiments_json(all);
  return table;
}

}  // namespace saccade::reproduce
