// SPDX-License-Identifier: Apache-2.0
#include "run_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "add_value.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

std::vector<double> parse_distances(const std::string& text) {
  const auto count = static_cast<std::size_t>(std::count(text.begin(), text.end(), ',')) + 1;
  const std::vector<double> distances_m = parse_numbers("--radius", text, count);
  for (const double distance_m : distances_m) require_positive(distance_m, "--radius");
  return distances_m;
}

}  // namespace

void add_run_options(CLI::App& command, RunOptions& options, const std::string& min_gain) {
  add_value(command, "--max-views", options.run.exploration.max_views, "N", "views at most, after the initial scan")
      ->check(CLI::Range(0, 1000));
  add_value(command, "--min-gain", options.min_gain, "GAIN",
            "gain below which a view is not worth going to (default: " + min_gain + ")");
  add_value(command, "--good-enough", options.run.exploration.good_enough, "SHARE",
            "share of the best view's gain at which another is as good, if the robot is there sooner");
  add_value(command, "--rivals", options.run.planner.rival_share, "SHARE",
            "attention: the view of most gain is looked for among segments at least so salient, as a share of the most "
            "salient; 1: of the most salient alone, as in the thesis");
  add_value(command, "--least-share", options.run.least_share, "SHARE",
            "surface: a view that promises less than this share of the surface seen so far is not worth going to");
  command.add_flag(
      "--as-printed", options.run.as_printed,
      "attention, standard, sphere: as in the thesis; of segments the most salient alone, and every promise "
      "is believed, whatever earlier views have shown; update: also hands by GMM-AS, a virtual sensor of all pixels, "
      "and gains of views that the robot cannot take");
  add_value(command, "--gain-width", options.gain_width_px, "PIXELS",
            "pixels across of the virtual sensor that views are chosen with (default: " +
                std::to_string(options.run.gain_width_px) + "; update --as-printed: the camera's)")
      ->check(CLI::Range(1, 100000));
  add_value(command, "--radius", options.distances, "METRES[,METRES...]",
            "distances of views from what they look at, metres: radii of the view sphere, and of contour views");
  add_value(command, "--voxel-size", options.run.voxel_size_m, "METRES", "edge of a voxel, metres");
  add_value(command, "--truncation", options.run.truncation_vox, "VOXELS", "truncation distance, voxels");
  add_clearing_option(command, options.run.clearing_percent);
  command.add_flag("--no-noise{false}", options.run.noise, "exact depth instead of that of the sensor");
  add_choice(command, "--sensor", options.run.sensor, kDepthSensorNames,
             "what the simulated camera's depth is like; a Kinect v2's goes through its filter (the image is "
             "--camera's)");
  add_camera_options(command, options.camera, true);
}

void add_foresight_options(CLI::App& command, RunOptions& options) {
  add_value(command, "--lookahead", options.run.exploration.lookahead, "N",
            "the next view is one of N that together are expected to show most; they are chosen anew after each")
      ->check(CLI::Range(1, 100));
  add_choice(
      command, "--objective", options.run.exploration.objective, kObjectiveNames,
      "what a view is chosen by: what it is expected to show, or that for the time of the motion and of looking");
  add_value(command, "--frame-on-way", options.run.exploration.frame_on_way_s, "SECONDS",
            "fuse a frame on an arm's way to a view, too, each time that these seconds have passed; what these are "
            "expected to show counts in the choice of the view (0: none)");
}

void check_foresight(const RunOptions& options, const std::string& robot) {
  if (options.run.exploration.frame_on_way_s > 0.0 && robot == "free") {
    usage_error("--frame-on-way", "a camera that flies is at the next view at once; this needs an arm");
  }
}

void check_run_options(RunOptions& options) {
  require_positive(options.run.voxel_size_m, "--voxel-size");
  require_positive(options.run.truncation_vox, "--truncation");
  require_ok(options.run.map().validate(), "--voxel-size, --truncation, --clearing");
  options.run.sphere.radii_m = parse_distances(options.distances);
  options.run.contour_views.distances_m = options.run.sphere.radii_m;
  options.run.camera = options.camera.camera(options.run.camera);
  options.run.gain_width_px = options.gain_width_px.value_or(options.run.gain_width_px);
  require_ok(options.run.planner.validate(), "--rivals");
  if (!(options.run.least_share >= 0.0 && options.run.least_share <= 1.0)) {
    usage_error("--least-share", "is a share: within 0 and 1");
  }
  require_ok(options.run.validate(), "the exploration");
}

std::string min_gain_by_strategy() {
  const double usual = NamedPlanner{}.min_gain;
  const Planners planners = builtin_planners();
  std::string text;
  for (const NamedPlanner& planner : planners.all()) {
    if (planner.min_gain == usual) continue;
    text += fixed(planner.min_gain, 0) + ' ' + planner.gain_unit + " for " + planner.name + ", ";
  }
  return text + "any for baselines, " + fixed(usual, 0) + " for the others";
}

void choose_strategy(RunOptions& options, const NamedPlanner& strategy) {
  options.run = options.run.with(strategy);
  if (options.min_gain) options.run.planner.min_gain = *options.min_gain;
  require_ok(options.run.planner.validate(), "--min-gain");
}

std::string noise_name(const SimulatedRunConfig& run) {
  if (!run.noise) return "none";
  return run.sensor == DepthSensor::kinect_v2 ? "Kinect v2, filtered" : "Kinect v1";
}

}  // namespace saccade::cli
