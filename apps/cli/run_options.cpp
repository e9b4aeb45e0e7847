// SPDX-License-Identifier: Apache-2.0
#include "run_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

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
  command.add_option("--max-views", options.run.exploration.max_views, "views at most, after the initial scan")
      ->check(CLI::Range(0, 1000))
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option("--min-gain", options.min_gain,
                  "gain below which a view is not worth going to (default: " + min_gain + ")")
      ->type_name("RAYS");
  command
      .add_option("--good-enough", options.run.exploration.good_enough,
                  "share of the best view's gain at which another is as good, if the robot is there sooner")
      ->type_name("SHARE")
      ->capture_default_str();
  command
      .add_option("--rivals", options.run.planner.rival_share,
                  "attention: the view of most gain is looked for among segments at least so salient, as a share of "
                  "the most salient; 1: of the most salient alone, as in the thesis")
      ->type_name("SHARE")
      ->capture_default_str();
  command
      .add_option("--gain-width", options.run.gain_width_px,
                  "pixels across of the virtual sensor that views are chosen with")
      ->check(CLI::Range(1, 100000))
      ->type_name("PIXELS")
      ->capture_default_str();
  command
      .add_option("--radius", options.distances,
                  "distances of views from what they look at, metres: radii of the view sphere, and of contour views")
      ->type_name("METRES[,METRES...]")
      ->capture_default_str();
  command.add_option("--voxel-size", options.run.voxel_size_m, "edge of a voxel, metres")
      ->type_name("METRES")
      ->capture_default_str();
  command.add_option("--truncation", options.run.truncation_vox, "truncation distance, voxels")
      ->type_name("VOXELS")
      ->capture_default_str();
  add_clearing_option(command, options.run.clearing_percent);
  command.add_flag("--no-noise{false}", options.run.noise, "exact depth instead of that of the sensor");
  add_choice(command, "--sensor", options.run.sensor, kDepthSensorNames,
             "what the simulated camera's depth is like; a Kinect v2's goes through its filter (the image is "
             "--camera's)");
  add_camera_options(command, options.camera, true);
}

void check_run_options(RunOptions& options) {
  require_positive(options.run.voxel_size_m, "--voxel-size");
  require_positive(options.run.truncation_vox, "--truncation");
  require_ok(options.run.map().validate(), "--voxel-size, --truncation, --clearing");
  options.run.sphere.radii_m = parse_distances(options.distances);
  options.run.contour_views.distances_m = options.run.sphere.radii_m;
  options.run.camera = options.camera.camera(options.run.camera);
  require_ok(options.run.planner.validate(), "--rivals");
  require_ok(options.run.validate(), "the exploration");
}

std::string min_gain_by_strategy() {
  return fixed(attention_planner().min_gain, 0) + " for attention, " + fixed(NamedPlanner{}.min_gain, 0) +
         " for the others";
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
