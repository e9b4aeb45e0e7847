// SPDX-License-Identifier: Apache-2.0
// Fig. 2.12: how far tracked poses drift over the time of a scan.
#include <algorithm>
#include <array>

#include "experiments/experiments.hpp"
#include "saccade/core/angle.hpp"
#include "tables.hpp"
#include "text.hpp"
#include "thesis/scan_motion.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;
using thesis::ScanTracking;

constexpr std::array<double, 4> kShares{0.25, 0.5, 0.75, 1.0};  ///< shares of the scan

std::size_t frame_at(const ScanTracking& tracking, double share) {
  const auto frames = static_cast<double>(tracking.translation_m.size());
  return static_cast<std::size_t>(std::max(1.0, share * frames)) - 1;
}

json curve_json(const UpdateScenario& scenario, const ScanTracking& tracking) {
  std::vector<double> time_s, turned_deg;
  for (std::size_t i = 0; i < tracking.translation_m.size(); ++i) {
    time_s.push_back(static_cast<double>(i) / thesis::kFrameRate_hz);
    turned_deg.push_back(to_deg(tracking.rotation_rad[i]));
  }
  return {{"scenario", scenario.number},
          {"scene", scenario.scene},
          {"depth_scale", tracking.depth_scale},
          {"time_s", time_s},
          {"translation_m", tracking.translation_m},
          {"rotation_deg", turned_deg}};
}

}  // namespace

Result<ReproducedTable> figure_2_12(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                    const Progress& progress) {
  SACCADE_CHECK(carry_out_tracked_scans(options, executor, progress, experiments.tracked_scans));
  const TrackedScans& scans = *experiments.tracked_scans;
  ReproducedTable table;
  table.caption = "Fig. 2.12: drift of egomotion over a scan: translation in millimetres / rotation in degrees";
  table.columns = {"scenario", "depth"};
  for (const double share : kShares) table.columns.push_back("after " + fixed(100.0 * share, 0) + " %");
  json rows = json::array();
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const UpdateScenario& scenario = kScenarios.at(i);
    for (const ScanTracking& tracking : scans.at(i)) {
      if (!tracking.egomotion) continue;
      std::vector<std::string> row{std::to_string(scenario.number) + ", " + scenario.scene,
                                   is_as_it_is(tracking) ? "as it is" : "1 % too long"};
      for (const double share : kShares) {
        const std::size_t frame = frame_at(tracking, share);
        row.push_back(fixed(1e3 * tracking.translation_m[frame], 1) + " / " +
                      fixed(to_deg(tracking.rotation_rad[frame]), 2));
      }
      table.rows.push_back(std::move(row));
      rows.push_back(curve_json(scenario, tracking));
    }
  }
  table.notes = {
      "The thesis shows the curve of its first scenario, which ends at about 120 mm. Here the motion that ICP finds is "
      "held against the true one of the simulated camera (Table 2.1 says how); its rows of a depth that is 1 % too "
      "long are ours."};
  table.figures = {{"rows", std::move(rows)}, {"frame_rate_hz", thesis::kFrameRate_hz}};
  if (options.draws) table.plots = drift_plots(scans);
  return table;
}

}  // namespace saccade::reproduce
