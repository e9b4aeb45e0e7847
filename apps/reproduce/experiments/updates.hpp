// SPDX-License-Identifier: Apache-2.0
#pragma once
// UpdateExperiments: both experiments of thesis §2.4.3, frames fused at viewpoints alone and in motion too, for Tables
// 2.7 and 2.8 and Figs. 2.16 to 2.20.

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "reproduced_table.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/explore/environment_update.hpp"
#include "table_options.hpp"

namespace saccade::reproduce {

/// Values that the thesis prints for one experiment.
struct ThesisExperiment {
  int number;
  const char* scene;
  FuseWhen fuse_when;
  double error_m;
  int completeness;  ///< 1 to 10, as judged by eye
  int views;
  double time_s;
  double clear_s;  ///< Table 2.8
  double nbv_s;
  double movement_s;
};
constexpr std::array<ThesisExperiment, 4> kUpdateExperiments{
    {{1, "bottle", FuseWhen::viewpoints, 0.005, 8, 3, 194.0, 0.07, 10.43, 6.86},
     {1, "bottle", FuseWhen::motion, 0.008, 9, 2, 191.0, 0.07, 10.91, 27.76},
     {2, "jug", FuseWhen::viewpoints, 0.005, 10, 5, 402.0, 0.08, 12.21, 7.58},
     {2, "jug", FuseWhen::motion, 0.007, 7, 3, 304.0, 0.06, 12.83, 20.71}}};

struct UpdatePictures {
  ColorImage hand;                  ///< trajectory, points of interest and regions in the map before
  ColorImage forgotten;             ///< the map with its regions unknown
  std::vector<ColorImage> choices;  ///< candidates of each view
  std::vector<ColorImage> seen;     ///< depth of each view
  std::vector<ColorImage> maps;     ///< after each view
  ColorImage after;
};

/// Result here.
struct OurUpdate {
  double mean_abs_error_m{0.0};
  double coverage{0.0};  ///< least of the regions, of all surfaces
  std::size_t regions{0};
  std::size_t views{0};
  double robot_s{0.0};      ///< time the simulated arm moves, in all
  double computing_s{0.0};  ///< from the hand's last sample to the arm at its stand-by, without that
  double clear_s{0.0};      ///< per region
  double nbv_s{0.0};        ///< per evaluation
  double movement_s{0.0};   ///< per view
  double evaluated{0.0};    ///< candidates per evaluation
  std::vector<std::vector<std::size_t>> unknown;  ///< voxels of each region: after the task, then after each view
  std::vector<std::size_t> region_of_view;        ///< region each view was chosen for
  std::size_t samples{0};                         ///< samples of the hand
  std::size_t gaussians{0};                       ///< Gaussians of the mixture; 0 where the detector makes none
  std::vector<double> off_m;                      ///< distance of each point of interest from the nearest true place
  // Settings of the run.
  std::string method;  ///< detector of actions
  int gain_width_px{0};
  double min_gain{0.0};
  UpdatePictures pictures;  ///< empty unless TableOptions::draws
};

/// One for each of kUpdateExperiments.
using UpdateExperiments = std::vector<OurUpdate>;

/// Carries the updates out unless they are there. cancelled; errors of `saccade update`.
[[nodiscard]] Status carry_out_updates(const TableOptions& options, const Executor& executor, const Progress& progress,
                                       std::optional<UpdateExperiments>& all);

/// KFOVP or KFOM.
[[nodiscard]] const char* thesis_name(FuseWhen when);
/// "here", or "here, as printed".
[[nodiscard]] std::string here_name(const TableOptions& options);
void add_update_notes(const TableOptions& options, const OurUpdate& update, ReproducedTable& table);
[[nodiscard]] nlohmann::json updates_json(const UpdateExperiments& all, bool as_printed);

}  // namespace saccade::reproduce
