// SPDX-License-Identifier: Apache-2.0
// Table 4.4: parameters of annotation, Saccade's beside those of the thesis.
#include <sstream>

#include "tables.hpp"
#include "thesis/annotation_figures.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;

/// As many decimals as it needs.
std::string number_text(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

}  // namespace

Result<ReproducedTable> table_4_4(const TableOptions& /*options*/, Experiments& /*experiments*/,
                                  const Executor& /*executor*/, const Progress& /*progress*/) {
  ReproducedTable table;
  table.caption = "Table 4.4: parameters of annotation";
  table.columns = {"parameter", "thesis", "here", "option of saccade annotate"};
  json rows = json::array();
  const auto add = [&](const char* parameter, double printed, double here, const char* option) {
    table.rows.push_back({parameter, number_text(printed), number_text(here), option});
    rows.push_back({{"parameter", parameter}, {"thesis", printed}, {"here", here}, {"option", option}});
  };
  const NeighbourhoodConfig& printed = thesis::kTable4_4;
  const NeighbourhoodConfig here;
  add("α_p, per metre", printed.position_weight_per_m, here.position_weight_per_m, "--position-weight");
  add("α_n", printed.normal_weight, here.normal_weight, "--normal-weight");
  add("α_c (an edge of the colour cube is 1)", printed.color_weight, here.color_weight, "--color-weight");
  add("Ω_max", printed.max_path, here.max_path, "--max-path");
  add("K_nn", printed.neighbours, here.neighbours, "--neighbours");
  table.notes = {
      "Ours are for single frames of a depth camera, the thesis' for clouds fused of many "
      "(docs/decisions/0014-annotation-weights.md). Tables 4.5, 4.6 and 4.8 have both."};
  table.figures = {{"rows", std::move(rows)}};
  return table;
}

}  // namespace saccade::reproduce
