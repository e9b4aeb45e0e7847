// SPDX-License-Identifier: Apache-2.0
// Fig. 3.8: what roundness and isolation bring to saliency.
#include "experiments/experiments.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_3_8(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                   const Progress& progress) {
  SACCADE_CHECK(carry_out_scan(options, executor, progress, experiments.salient_scan));
  const SegmentedScan& scan = *experiments.salient_scan;
  const MeasuredSegments segments{scan.points, scan.measures, {}};
  const std::vector<Judgement> judgements{judge("roundness alone", roundness_alone(), segments),
                                          judge("isolation alone", isolation_alone(), segments),
                                          judge("roundness and isolation", objectness(), segments)};
  ReproducedTable table = table_of(scan, judgements, "saliency");
  table.caption = "Fig. 3.8: saliency by roundness alone, by isolation alone, and by both (eq. 3.12)";
  table.notes.emplace_back(
      "\"Objects before any other\": how many segments of objects a planner that goes by saliency comes to before the "
      "first segment of something else.");
  if (!options.draws) return table;
  std::vector<Panel> panels{segments_panel(scan.drawn(), scan.measures, scan.view, executor)};
  panels[0].title += " of the map's surface";
  for (const Judgement& judgement : judgements) {
    panels.push_back(panel_of(scan, judgement, most_of(judgement), executor));
  }
  table.pictures.push_back(
      {"fig-3-8.png", compose({"Saliency of the segments (thesis Fig. 3.8)", panels, picture_note()})});
  return table;
}

}  // namespace saccade::reproduce
