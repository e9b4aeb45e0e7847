// SPDX-License-Identifier: Apache-2.0
// Tables 4.4 and 4.7: parameters of annotation, ours beside the thesis', and what its users thought, as it says.
#include <sstream>

#include "summary.hpp"
#include "tables/thesis_table.hpp"
#include "thesis/annotation_figures.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

/// As many decimals as it needs.
std::string number_text(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string text_of(const thesis::MeanAndDeviation& value) {
  return fixed(value.mean, 1) + " ± " + fixed(value.deviation, 1);
}

}  // namespace

Result<ReproducedTable> reproduce_table_4_4(const ReproduceOptions& /*options*/, const Executor& /*executor*/,
                                            const Progress& /*progress*/) {
  ReproducedTable table;
  table.caption = "Table 4.4: parameters of annotation";
  table.columns = {"parameter", "thesis", "here", "option of saccade annotate"};
  json rows = json::array();
  const auto add = [&](const char* parameter, double printed, double ours, const char* option) {
    table.rows.push_back({parameter, number_text(printed), number_text(ours), option});
    rows.push_back({{"parameter", parameter}, {"thesis", printed}, {"here", ours}, {"option", option}});
  };
  const NeighbourhoodConfig& printed = thesis::kTable4_4;
  const NeighbourhoodConfig ours;
  add("α_p, per metre", printed.position_weight_per_m, ours.position_weight_per_m, "--position-weight");
  add("α_n", printed.normal_weight, ours.normal_weight, "--normal-weight");
  add("α_c (an edge of the colour cube is 1)", printed.color_weight, ours.color_weight, "--color-weight");
  add("Ω_max", printed.max_path, ours.max_path, "--max-path");
  add("K_nn", printed.neighbours, ours.neighbours, "--neighbours");
  table.notes = {
      "Ours are for single frames of a depth camera, the thesis' for clouds fused of many "
      "(docs/decisions/0014-annotation-weights.md). Tables 4.5, 4.6 and 4.8 have both."};
  table.figures = {{"rows", std::move(rows)}};
  return table;
}

Result<ReproducedTable> reproduce_table_4_7(const ReproduceOptions& /*options*/, const Executor& /*executor*/,
                                            const Progress& /*progress*/) {
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

}  // namespace saccade::cli
