// SPDX-License-Identifier: Apache-2.0
// Table 4.7: what users of the thesis thought of annotation, quoted.
#include "tables.hpp"
#include "text.hpp"
#include "thesis/annotation_figures.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;

std::string text_of(const thesis::MeanAndDeviation& value) {
  return fixed(value.mean, 1) + " ± " + fixed(value.deviation, 1);
}

}  // namespace

Result<ReproducedTable> table_4_7(const TableOptions& /*options*/, Experiments& /*experiments*/,
                                  const Executor& /*executor*/, const Progress& /*progress*/) {
  ReproducedTable table;
  table.caption = "Table 4.7: what users thought of annotation, from 0 to 10 (quoted)";
  table.columns = {"thesis", "control points", "rectangles", "p < 0.05"};
  json rows = json::array();
  for (const thesis::Opinion& opinion : thesis::kTable4_7) {
    table.rows.push_back({std::string{opinion.index}, text_of(opinion.control_points), text_of(opinion.rectangles),
                          opinion.differ ? "yes" : "no"});
    rows.push_back({{"index", opinion.index},
                    {"control_points", opinion.control_points.mean},
                    {"rectangles", opinion.rectangles.mean},
                    {"significant", opinion.differ}});
  }
  table.notes = {
      "A questionnaire that the thesis' ten users answered. Only people can repeat it: there is nothing of ours "
      "beside it."};
  table.figures = {{"quoted", true}, {"rows", std::move(rows)}};
  return table;
}

}  // namespace saccade::reproduce
