// SPDX-License-Identifier: Apache-2.0
// Table 4.3: errors of segmented surfels with and without the mode filter.
#include "experiments/experiments.hpp"
#include "tables.hpp"
#include "text.hpp"
#include "thesis/surfel_figures.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;
using thesis::SurfelColors;
using thesis::SurfelTrial;

constexpr int kErrorDecimals{3};

std::string least(const ScoreCurve& curve) {
  const std::optional<CurvePoint> best = curve.least_bce();
  return best ? fixed(best->score.bce, kErrorDecimals) : "–";
}

}  // namespace

Result<ReproducedTable> table_4_3(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                  const Progress& progress) {
  SACCADE_TRY(const DoneTrials trials, surfel_trials(options, executor, progress, experiments.surfels));
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

}  // namespace saccade::reproduce
