// SPDX-License-Identifier: Apache-2.0
#pragma once
// TrackedScans: both scans of thesis §2.4.1, fused by tracked poses and by those of the arm, for Table 2.1 and
// Fig. 2.12.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "reproduced_table.hpp"
#include "table_options.hpp"
#include "thesis/scan_tracking.hpp"

namespace saccade::reproduce {

struct ThesisErrors {
  double mean_abs_m;
  double standard_deviation_m;
};

struct UpdateScenario {
  int number;
  const char* scene;
  ThesisErrors egomotion;
  ThesisErrors kinematics;
};
constexpr std::array<UpdateScenario, 2> kScenarios{
    {{1, "bottle", {0.031, 0.040}, {0.005, 0.006}}, {2, "jug", {0.027, 0.041}, {0.006, 0.008}}}};
constexpr double kThesisDrift_m{0.12};  // "at the end ... about 12 cm"

/// The ways to know the camera's pose, for each of kScenarios.
using TrackedScans = std::array<std::vector<thesis::ScanTracking>, kScenarios.size()>;

[[nodiscard]] thesis::ScanTrackingConfig tracking_config(const TableOptions& options);
/// Carries the scans out unless they are there. Errors of track_scan.
[[nodiscard]] Status carry_out_tracked_scans(const TableOptions& options, const Executor& executor,
                                             const Progress& progress, std::optional<TrackedScans>& scans);

[[nodiscard]] double greatest(const std::vector<double>& values);
/// Whether the camera measures depth as it is, or one percent too long.
[[nodiscard]] bool is_as_it_is(const thesis::ScanTracking& tracking);
/// Draws Fig. 2.12: a plot of translation, and one of rotation.
[[nodiscard]] std::vector<TablePlot> drift_plots(const TrackedScans& scans);

}  // namespace saccade::reproduce
