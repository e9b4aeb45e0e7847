// SPDX-License-Identifier: Apache-2.0
// Tables 2.7 and 2.8: both experiments of thesis §2.4.3, frames fused at viewpoints alone and in motion too.
#include <array>
#include <numeric>

#include "saccade/core/clock.hpp"
#include "saccade/map/mesh.hpp"
#include "summary.hpp"
#include "tables/thesis_table.hpp"
#include "update.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

/// What the thesis prints of one experiment.
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
constexpr std::array<ThesisExperiment, 4> kExperiments{
    {{1, "bottle", FuseWhen::viewpoints, 0.005, 8, 3, 194.0, 0.07, 10.43, 6.86},
     {1, "bottle", FuseWhen::motion, 0.008, 9, 2, 191.0, 0.07, 10.91, 27.76},
     {2, "jug", FuseWhen::viewpoints, 0.005, 10, 5, 402.0, 0.08, 12.21, 7.58},
     {2, "jug", FuseWhen::motion, 0.007, 7, 3, 304.0, 0.06, 12.83, 20.71}}};

/// The same here.
struct OurExperiment {
  double mean_abs_error_m{0.0};
  double coverage{0.0};  ///< least of the regions, of all surfaces
  std::size_t regions{0};
  std::size_t views{0};
  double robot_s{0.0};      ///< of the simulated arm, in all
  double computing_s{0.0};  ///< from the hand's last sample to the arm at its stand-by, without that
  double clear_s{0.0};      ///< per region
  double nbv_s{0.0};        ///< per evaluation
  double movement_s{0.0};   ///< per view
  double evaluated{0.0};    ///< candidates per evaluation
  // What it was done with.
  std::string method;  ///< detector of actions
  int gain_width_px{0};
  double min_gain{0.0};
};

const char* thesis_name(FuseWhen when) { return when == FuseWhen::viewpoints ? "KFOVP" : "KFOM"; }

double mean_abs_error_m(const json& objects) {
  double sum_m = 0.0;
  double count = 0.0;
  for (const json& object : objects) {
    if (object.at("error").is_null()) continue;
    for (const auto& [parameter, error_m] : object.at("error").items()) {
      sum_m += std::abs(error_m.get<double>());
      count += 1.0;
    }
  }
  return count > 0.0 ? sum_m / count : std::nan("");
}

double least_coverage(const json& regions) {
  double least = 1.0;
  for (const json& region : regions) {
    const json& surfaces = region.at("coverage").at("surfaces");
    if (!surfaces.is_null()) least = std::min(least, surfaces.get<double>());
  }
  return least;
}

UpdateOptions options_of(const ThesisExperiment& experiment, const ReproduceOptions& reproduce) {
  UpdateOptions options;
  options.scene = experiment.scene;
  options.fuse_when = experiment.fuse_when;
  options.run.as_printed = reproduce.as_printed;
  if (reproduce.image_width_px > 0)
    options.camera.image_size = {reproduce.image_width_px, reproduce.image_width_px * 3 / 4};
  GlobalOptions global;
  global.seed = reproduce.seed;
  check_update_options(options, global);
  return options;
}

Result<OurExperiment> carry_out(const ThesisExperiment& experiment, const ReproduceOptions& reproduce,
                                const Executor& executor, const Progress& progress) {
  const UpdateOptions options = options_of(experiment, reproduce);
  SACCADE_TRY(const UpdateCase subject, open_update_case(options));
  SACCADE_TRY(const WatchedTask task, watch_task(options, subject));
  SACCADE_TRY(ExploreDevices devices, open_update_devices(options, subject, executor));
  SACCADE_TRY(const UpdateFigures figures, run_update(options, subject, task, devices, executor, progress));
  if (figures.interrupted) return Error{Errc::cancelled, "cancelled", std::string{"experiment "} + experiment.scene};
  SACCADE_TRY(const json result, update_json(options, subject, task, figures, devices, executor, progress));
  OurExperiment ours;
  ours.mean_abs_error_m = mean_abs_error_m(result.at("objects"));
  ours.coverage = least_coverage(result.at("regions"));
  ours.regions = result.at("regions").size();
  ours.views = result.at("views").size();
  ours.method = options.method->name;
  ours.gain_width_px = options.run.gain_width_px;
  ours.min_gain = options.run.planner.min_gain;
  ours.computing_s = 1e-3 * task.ms;
  const json& phases = result.at("phases_s");
  ours.robot_s = phases.at("robot").get<double>();
  for (const auto& [phase, s] : phases.items()) {
    if (phase != "robot" && phase != "motion") ours.computing_s += s.get<double>();
  }
  const auto views = static_cast<double>(std::max<std::size_t>(1, ours.views));
  ours.clear_s = phases.at("forgetting").get<double>() / static_cast<double>(std::max<std::size_t>(1, ours.regions));
  const auto of = [&](const char* phase) { return phases.value(phase, 0.0); };
  ours.nbv_s = (of("candidates") + of("reachability") + of("evaluation")) / views;
  ours.movement_s = ours.robot_s / (views + 1.0);  // the way back is one more
  for (const json& view : result.at("views")) ours.evaluated += view.at("evaluated").get<double>() / views;
  return ours;
}

Result<std::vector<OurExperiment>> carry_out_all(const ReproduceOptions& options, const Executor& executor,
                                                 const Progress& progress) {
  std::vector<OurExperiment> all;
  for (const ThesisExperiment& experiment : kExperiments) {
    progress.report("experiments", all.size(), kExperiments.size());
    SACCADE_TRY(OurExperiment ours, carry_out(experiment, options, executor, progress));
    all.push_back(ours);
  }
  return all;
}

json figures_of(const std::vector<OurExperiment>& all, bool as_printed) {
  json rows = json::array();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ThesisExperiment& thesis = kExperiments.at(i);
    const OurExperiment& ours = all[i];
    rows.push_back({{"experiment", thesis.number},
                    {"scene", thesis.scene},
                    {"fuse_when", to_string(thesis.fuse_when)},
                    {"thesis",
                     {{"error_m", thesis.error_m},
                      {"completeness_of_10", thesis.completeness},
                      {"views", thesis.views},
                      {"time_s", thesis.time_s},
                      {"clear_s", thesis.clear_s},
                      {"nbv_s", thesis.nbv_s},
                      {"movement_s", thesis.movement_s}}},
                    {"error_m", ours.mean_abs_error_m},
                    {"coverage", ours.coverage},
                    {"regions", ours.regions},
                    {"views", ours.views},
                    {"robot_s", ours.robot_s},
                    {"computing_s", ours.computing_s},
                    {"clear_s", ours.clear_s},
                    {"nbv_s", ours.nbv_s},
                    {"movement_s", ours.movement_s},
                    {"evaluated", ours.evaluated},
                    {"method", ours.method},
                    {"gain_width_px", ours.gain_width_px},
                    {"min_gain", ours.min_gain}});
  }
  return {{"as_printed", as_printed}, {"rows", std::move(rows)}};
}

/// What of ours took part, or with --as-printed what of the thesis took its place, and what of the thesis did not.
std::vector<std::string> setting_notes(const ReproduceOptions& options, const OurExperiment& ours) {
  const std::string rays = std::to_string(ours.gain_width_px) + " rays across and IncTh " +
                           fixed(ours.min_gain, ours.min_gain < 20.0 ? 1 : 0);
  if (!options.as_printed) {
    return {
        "Ours, not the thesis': hands by the dip detector, promises of views are believed only where they are "
        "credible, and gains of views that the arm can take alone, with " +
        rays + ". --as-printed does what the thesis prints; docs/update.md says what differs then."};
  }
  return {
      "As printed (--as-printed): hands by GMM-AS, every promise is believed, and all 960 views are evaluated "
      "before the arm is asked, with " +
          rays + " (the thesis does not print IncTh: here it is the same share of all rays as without --as-printed).",
      "Not as printed: GMM-AS has the formula and POITh that give the thesis' own tables, since by eq. 2.13 and 2.5 "
      "it finds other places than those where the hand acted; after a view the best of the new ranking is next, "
      "where the letter of Algorithm 1 would go on with the number of the last; free space is counted to W_th "
      "(decision 1)."};
}

std::string here_name(const ReproduceOptions& options) { return options.as_printed ? "here, as printed" : "here"; }

void add_common_notes(const ReproduceOptions& options, const OurExperiment& ours, ReproducedTable& table) {
  for (std::string& note : setting_notes(options, ours)) table.notes.push_back(std::move(note));
  table.notes.emplace_back(
      "Here the scenes, the hand, the arm and the camera with its noise are simulated (`saccade update --scene "
      "bottle|jug`); the thesis' were real. The objects, the table and the room are of our making, so figures compare "
      "in "
      "kind, not to the digit.");
  if (options.image_width_px > 0) {
    table.notes.push_back("Images are " + std::to_string(options.image_width_px) +
                          " pixels wide (--image-width), which is quicker, but not what the thesis did.");
  }
}

}  // namespace

Result<ReproducedTable> reproduce_table_2_7(const ReproduceOptions& options, const Executor& executor,
                                            const Progress& progress) {
  SACCADE_TRY(const std::vector<OurExperiment> all, carry_out_all(options, executor, progress));
  ReproducedTable table;
  table.caption = "Table 2.7: error, completeness, views and time of updates; thesis / " + here_name(options);
  table.columns = {"experiment", "frames fused", "mean abs. error (m)", "completeness", "views", "time (s)"};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ThesisExperiment& thesis = kExperiments.at(i);
    const OurExperiment& ours = all[i];
    table.rows.push_back({std::to_string(thesis.number) + ", " + thesis.scene, thesis_name(thesis.fuse_when),
                          fixed(thesis.error_m, 3) + " / " + fixed(ours.mean_abs_error_m, 4),
                          std::to_string(thesis.completeness) + " of 10 / " + percent(ours.coverage),
                          std::to_string(thesis.views) + " / " + std::to_string(ours.views),
                          fixed(thesis.time_s, 0) + " / " + fixed(ours.robot_s + ours.computing_s, 1)});
  }
  table.notes = {
      "Errors are of the height and both axes of the object that was put down (docs/metrics.md).",
      "Completeness: the thesis gave marks from 1 to 10 by eye; here it is the share of the surface that can be seen "
      "inside a region, table included, which the mesh has within a voxel, of the region that has least.",
      "Time: here what the simulated arm's motions take, and what was computed between them on this machine; the "
      "thesis' is that of its whole system.",
      "In the second experiment the thesis had three regions, two of them almost the same; here there are as many as "
      "the detector found: " +
          std::to_string(all.back().regions) + "."};
  add_common_notes(options, all.front(), table);
  table.figures = figures_of(all, options.as_printed);
  return table;
}

Result<ReproducedTable> reproduce_table_2_8(const ReproduceOptions& options, const Executor& executor,
                                            const Progress& progress) {
  SACCADE_TRY(const std::vector<OurExperiment> all, carry_out_all(options, executor, progress));
  ReproducedTable table;
  table.caption =
      "Table 2.8: seconds of the most relevant phases, mean of each experiment; thesis / " + here_name(options);
  table.columns = {"phase"};
  for (const ThesisExperiment& thesis : kExperiments) {
    table.columns.push_back(std::string{thesis.scene} + ", " + thesis_name(thesis.fuse_when));
  }
  const auto add = [&](const char* phase, double ThesisExperiment::*thesis, double OurExperiment::*ours, int digits) {
    std::vector<std::string> row{phase};
    for (std::size_t i = 0; i < all.size(); ++i) {
      row.push_back(fixed(kExperiments.at(i).*thesis, 2) + " / " + fixed(all[i].*ours, digits));
    }
    table.rows.push_back(std::move(row));
  };
  add("clear S(POI)", &ThesisExperiment::clear_s, &OurExperiment::clear_s, 5);
  add("next best view", &ThesisExperiment::nbv_s, &OurExperiment::nbv_s, 4);
  add("robot movement", &ThesisExperiment::movement_s, &OurExperiment::movement_s, 2);
  table.notes = {
      "Next best view: here candidates, reachability and gains of one choice, of " + fixed(all.front().evaluated, 0) +
          " poses in the first experiment. How long each ray of every pose takes, also for others, is Table 2.9.",
      "Robot movement: here the mean of the ways to the views, their oscillation included, and of the way back. In "
      "motion the arm has a quarter of its speed."};
  add_common_notes(options, all.front(), table);
  table.figures = figures_of(all, options.as_printed);
  return table;
}

}  // namespace saccade::cli
