// SPDX-License-Identifier: Apache-2.0
// Table 4.2: parameters of surfels, mode filter and evaluation.
#include <sstream>

#include "saccade/segment/flood_fill.hpp"
#include "saccade/surfel/mode_filter.hpp"
#include "saccade/surfel/surfel_fusion.hpp"
#include "tables.hpp"
#include "thesis/surfel_figures.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;

}  // namespace

Result<ReproducedTable> table_4_2(const TableOptions& /*options*/, Experiments& /*experiments*/,
                                  const Executor& /*executor*/, const Progress& /*progress*/) {
  ReproducedTable table;
  table.caption = "Table 4.2: parameters of surfels, mode filter and evaluation";
  table.columns = {"parameter", "thesis", "default here"};
  json rows = json::array();
  const auto number_text = [](double value) {
    std::ostringstream text;
    text << value;
    return text.str();
  };
  const auto add = [&](const char* parameter, double printed, double here) {
    table.rows.push_back({parameter, number_text(printed), number_text(here)});
    rows.push_back({{"parameter", parameter}, {"thesis", printed}, {"here", here}});
  };
  const ModeFilterConfig filter;
  const FloodFillConfig filling;
  add("σ_c", thesis::kColorSigma, filter.guided.color_sigma);
  add("σ_d, m", thesis::kDepthSigma_m, filter.guided.depth_sigma_m);
  add("K", thesis::kColorSigmas, filter.color_sigmas);
  add("R_m, pixels", thesis::kMeanRadius_px, filter.guided.radius_px);
  add("M_max", thesis::kMaxModes, filter.max_modes);
  add("σ_img", thesis::kImageSigma, SurfelFusionConfig{}.image_sigma);
  add("T_eval, m", thesis::kEvaluation_m, BoundaryMatchingConfig{}.tolerance_m);
  add("α_n of flood fill", thesis::kNormalWeight, filling.normal_weight);
  add("α_c of flood fill", thesis::kColorWeight, filling.color_weight);
  table.notes = {
      "Supervoxels have the thesis' parameters in Tables 4.3 and Fig. 4.11 (V_lccp 1 cm, S_lccp 5 cm, α_p 0.1, "
      "α_n 0.5, α_c 1). σ_img is 0.1 in the scene with vignetting, the third, as in the thesis."};
  table.figures = {{"rows", std::move(rows)}};
  return table;
}

}  // namespace saccade::reproduce
