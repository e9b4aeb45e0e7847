// SPDX-License-Identifier: Apache-2.0
// Fig. 3.9: saliency for five distances B_th of isolation.
#include <algorithm>
#include <array>

#include "experiments/experiments.hpp"
#include "tables.hpp"
#include "text.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_3_9(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                   const Progress& progress) {
  constexpr std::array<double, 5> kDistances_m{0.005, 0.01, 0.02, 0.05, 0.1};  // the thesis'
  SACCADE_CHECK(carry_out_scan(options, executor, progress, experiments.salient_scan));
  const SegmentedScan& scan = *experiments.salient_scan;
  std::vector<Judgement> judgements;
  for (const double distance_m : kDistances_m) {
    const MeasureConfig config{distance_m};
    SACCADE_TRY(const std::vector<SegmentMeasures> measures, measure_segments(scan.points, config, executor));
    judgements.push_back(judge(fixed(distance_m, 3) + " m", objectness(), {scan.points, measures, config}));
  }
  ReproducedTable table = table_of(scan, judgements, "B_th");
  table.caption = "Fig. 3.9: saliency (eq. 3.12) for five distances B_th of isolation; the thesis takes 0.02 m";
  if (!options.draws) return table;
  double most{0.0};  // one scale for all panels
  for (const Judgement& judgement : judgements) most = std::max(most, most_of(judgement));
  std::vector<Panel> panels;
  for (const Judgement& judgement : judgements) {
    panels.push_back(panel_of(scan, judgement, most, executor));
    panels.back().title = "B_th = " + judgement.name;
  }
  table.pictures.push_back(
      {"fig-3-9.png", compose({"Saliency for five distances B_th (thesis Fig. 3.9)", panels, picture_note()})});
  return table;
}

}  // namespace saccade::reproduce
