// SPDX-License-Identifier: Apache-2.0
// Table 4.2: parameters of surfels, mode filter and evaluation.
#include <array>
#include <sstream>

#include "experiments/surfel_trials.hpp"
#include "saccade/surfel/surfel_fusion.hpp"
#include "tables.hpp"
#include "thesis/surfel_figures.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;
using thesis::SurfelTrialConfig;

std::string parameter_text(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// A parameter of ours that --as-printed sets, where the thesis has no number.
struct Switch {
  const char* name;
  double (*value)(const SurfelTrialConfig& config);
};

constexpr std::array kSwitches{
    Switch{"Gaussian of the choice, σ_c; 0: the heaviest mode (eq. 4.11)",
           [](const SurfelTrialConfig& c) { return c.mode_filter.choice_sigmas; }},
    Switch{"λ of sharpened modes", [](const SurfelTrialConfig& c) { return c.mode_filter.sharpening.strength; }},
    Switch{"largest change of a depth, m", [](const SurfelTrialConfig& c) { return c.mode_filter.max_depth_change_m; }},
    Switch{"surfels are where their modes are", [](const SurfelTrialConfig& c) { return double(c.places_of_modes); }},
    Switch{"unknown normals equal all (eq. 4.14)",
           [](const SurfelTrialConfig& c) { return double(c.flood_fill.unknown_is_alike); }},
    Switch{"rounds of growth", [](const SurfelTrialConfig& c) { return double(c.sv_lccp.supervoxels.rounds); }},
    Switch{"supervoxels move in growth",
           [](const SurfelTrialConfig& c) { return double(c.sv_lccp.supervoxels.moves_in_growth); }},
    Switch{"seeds settle", [](const SurfelTrialConfig& c) { return double(c.sv_lccp.supervoxels.seeds_settle); }},
    Switch{"a seed needs a share of a plane of",
           [](const SurfelTrialConfig& c) { return c.sv_lccp.supervoxels.min_seed_share; }},
    Switch{"reach of growth, seed spacings", [](const SurfelTrialConfig& c) { return c.sv_lccp.supervoxels.reach; }},
    Switch{"normals have no sides",
           [](const SurfelTrialConfig& c) { return double(c.sv_lccp.supervoxels.opposite_is_alike); }},
    Switch{"LCCP: sanity", [](const SurfelTrialConfig& c) { return double(c.sv_lccp.lccp.sanity); }},
    Switch{"LCCP: smoothness", [](const SurfelTrialConfig& c) { return double(c.sv_lccp.lccp.smooth); }}};

/// Adds what --as-printed changes, beside the default.
void add_switches(const SurfelTrialConfig& here, ReproducedTable& table) {
  json switches = json::array();
  const SurfelTrialConfig usual;
  for (const Switch& each : kSwitches) {
    const std::string printed_text = parameter_text(each.value(here));
    const std::string default_text = parameter_text(each.value(usual));
    table.rows.push_back({each.name, "–", printed_text, default_text});
    switches.push_back({{"switch", each.name}, {"as_printed", printed_text}, {"default", default_text}});
  }
  table.figures["switches"] = std::move(switches);
  table.notes.emplace_back(
      "Rows without a figure of the thesis are what it says in words, or leaves to PCL, whose values are those of PCL "
      "1.13 where nothing is set; 1: yes, 0: no.");
}

}  // namespace

Result<ReproducedTable> table_4_2(const TableOptions& options, Experiments& /*experiments*/,
                                  const Executor& /*executor*/, const Progress& /*progress*/) {
  ReproducedTable table;
  table.caption = "Table 4.2: parameters of surfels, mode filter and evaluation";
  table.columns = {"parameter", "thesis", "default here"};
  if (options.as_printed) table.columns = {"parameter", "thesis", "here, as printed", "default here"};
  json rows = json::array();
  const SurfelTrialConfig config = surfel_trial_config(options);
  const auto add = [&](const char* parameter, double printed, const auto& value) {
    const double here = value(config);
    table.rows.push_back({parameter, parameter_text(printed), parameter_text(here)});
    if (options.as_printed) table.rows.back().push_back(parameter_text(value(SurfelTrialConfig{})));
    rows.push_back({{"parameter", parameter}, {"thesis", printed}, {"here", here}});
  };
  using Config = const SurfelTrialConfig&;
  add("σ_c", thesis::kColorSigma, [](Config c) { return c.mode_filter.guided.color_sigma; });
  add("σ_d, m", thesis::kDepthSigma_m, [](Config c) { return c.mode_filter.guided.depth_sigma_m; });
  add("K", thesis::kColorSigmas, [](Config c) { return c.mode_filter.color_sigmas; });
  add("R_m, pixels", thesis::kMeanRadius_px, [](Config c) { return double(c.mode_filter.guided.radius_px); });
  add("M_max", thesis::kMaxModes, [](Config c) { return double(c.mode_filter.max_modes); });
  add("σ_img", thesis::kImageSigma, [](Config) { return SurfelFusionConfig{}.image_sigma; });
  add("T_eval, m", thesis::kEvaluation_m, [](Config) { return BoundaryMatchingConfig{}.tolerance_m; });
  add("α_n of flood fill", thesis::kNormalWeight, [](Config c) { return c.flood_fill.normal_weight; });
  add("α_c of flood fill", thesis::kColorWeight, [](Config c) { return c.flood_fill.color_weight; });
  add("V_lccp, m", thesis::kVoxel_m, [](Config c) { return c.sv_lccp.supervoxels.voxels.voxel_size_m; });
  add("S_lccp, m", thesis::kSupervoxel_m, [](Config c) { return c.sv_lccp.supervoxels.seed_spacing_m; });
  add("α_p of supervoxels", thesis::kPositionWeight, [](Config c) { return c.sv_lccp.supervoxels.spatial_weight; });
  add("α_n of supervoxels", thesis::kNormalWeight, [](Config c) { return c.sv_lccp.supervoxels.normal_weight; });
  add("α_c of supervoxels", thesis::kColorWeight, [](Config c) { return c.sv_lccp.supervoxels.color_weight; });
  table.notes = {"σ_img is 0.1 in the scene with vignetting, the third, as in the thesis."};
  table.figures = {{"rows", std::move(rows)}};
  if (options.as_printed) add_switches(config, table);
  return table;
}

}  // namespace saccade::reproduce
