// SPDX-License-Identifier: Apache-2.0
// Fig. 3.16: candidate viewpoints before the third view of experiment 1, of all segments and of the most salient one.
#include <algorithm>
#include <limits>

#include "experiments/experiments.hpp"
#include "saccade/attention/salient_objects.hpp"
#include "saccade/report/sheet.hpp"
#include "saccade/views/contours.hpp"
#include "tables.hpp"
#include "text.hpp"

namespace saccade::reproduce {

Result<ReproducedTable> figure_3_16(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                    const Progress& progress) {
  constexpr std::size_t kThirdView{2};
  SACCADE_TRY(const Exploration* found,
              exploration(options, executor, progress, experiments.explorations.attention, 0));
  if (found->run.views.size() <= kThirdView || !found->run.views[kThirdView].choice->segment) {
    return Error{Errc::unavailable, "the exploration ended before its third view", kTabletops[0]};
  }
  const ViewRecord& third = found->run.views[kThirdView];
  const ViewChoice& choice = *third.choice;
  const std::size_t per_point = ContourViewConfig{}.views_per_point();
  const auto contours_of = choice.contours->points_of_segments(choice.surface->points.segments());
  const std::size_t of_chosen = per_point * contours_of[*choice.segment].size();
  ReproducedTable table;
  table.caption = "Fig. 3.16: candidate viewpoints before the third view of experiment 1";
  table.columns = {"candidates", "thesis", "here"};
  table.rows = {{"of all segments", "91960", std::to_string(third.candidates)},
                {"of the segment that was chosen", "960", std::to_string(of_chosen)},
                {"of these, those that the arm can take", "not said", std::to_string(choice.candidates.size())},
                {"evaluated in all", "960", std::to_string(third.evaluated)}};
  table.notes = {"Each contour point has " + std::to_string(per_point) +
                 " candidates. Here segments whose views the arm cannot take are passed over first."};
  add_exploration_notes(options, table);
  table.figures = {{"rows",
                    {{{"candidates", "all"}, {"thesis", 91960}, {"here", third.candidates}},
                     {{"candidates", "chosen"}, {"thesis", 960}, {"here", of_chosen}},
                     {{"candidates", "reachable"}, {"thesis", nullptr}, {"here", choice.candidates.size()}},
                     {{"candidates", "evaluated"}, {"thesis", 960}, {"here", third.evaluated}}}}};
  if (!options.draws || found->pictures.candidates.size() <= kThirdView) return table;
  table.pictures.push_back(
      {"fig-3-16.png",
       compose(
           {"Before the third view of experiment 1 (thesis Fig. 3.16)",
            {{found->pictures.saliencies.at(kThirdView), "contours of all segments, chosen ones marked", {}, {}, {}},
             {found->pictures.candidates[kThirdView], "candidates of the chosen segment", {}, {}, {}}},
            ""})});
  return table;
}

}  // namespace saccade::reproduce
