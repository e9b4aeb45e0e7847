// SPDX-License-Identifier: Apache-2.0
#include "run_options.hpp"

#include <CLI/CLI.hpp>

namespace saccade::cli {

void add_run_options(CLI::App& command, RunOptions& options) {
  command.add_option("--max-views", options.run.exploration.max_views, "views at most, after the initial scan")
      ->check(CLI::Range(0, 1000))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--min-gain", options.run.exploration.min_gain, "gain below which a region is done")
      ->type_name("RAYS")
      ->capture_default_str();
  command
      .add_option("--good-enough", options.run.exploration.good_enough,
                  "share of the best view's gain at which another is as good, if the robot is there sooner")
      ->type_name("SHARE")
      ->capture_default_str();
  command
      .add_option("--gain-width", options.run.gain_width_px,
                  "pixels across of the virtual sensor that views are chosen with")
      ->check(CLI::Range(1, 100000))
      ->type_name("PIXELS")
      ->capture_default_str();
  command.add_option("--radius", options.radius_m, "radius of the view sphere, metres")
      ->type_name("METRES")
      ->capture_default_str();
  command.add_option("--voxel-size", options.run.voxel_size_m, "edge of a voxel, metres")
      ->type_name("METRES")
      ->capture_default_str();
  command.add_option("--truncation", options.run.truncation_vox, "truncation distance, voxels")
      ->type_name("VOXELS")
      ->capture_default_str();
  command.add_flag("--no-noise{false}", options.run.noise, "exact depth instead of that of the sensor");
  command
      .add_option_function<std::string>(
          "--sensor",
          [&options](const std::string& text) {
            const auto sensor = depth_sensor(text);
            require_ok(sensor ? Status{} : Status{sensor.error()}, "--sensor");
            options.run.sensor = *sensor;
          },
          "what the simulated camera's depth is like; a Kinect v2's goes through its filter (default: kinect-v1; the "
          "image is --camera's)")
      ->type_name("kinect-v1|kinect-v2");
  add_camera_options(command, options.camera, true);
}

void check_run_options(RunOptions& options) {
  require_positive(options.run.voxel_size_m, "--voxel-size");
  require_positive(options.run.truncation_vox, "--truncation");
  require_positive(options.radius_m, "--radius");
  require_ok(options.run.map().validate(), "--voxel-size, --truncation");
  options.run.sphere.radii_m = {options.radius_m};
  options.run.camera = options.camera.camera(options.run.camera);
  require_ok(options.run.validate(), "the exploration");
}

std::string noise_name(const SimulatedRunConfig& run) {
  if (!run.noise) return "none";
  return run.sensor == DepthSensor::kinect_v2 ? "Kinect v2, filtered" : "Kinect v1";
}

}  // namespace saccade::cli
