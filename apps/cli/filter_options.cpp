// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <numbers>

#include "filter.hpp"

namespace saccade::cli {
namespace {

constexpr double kRadPerDegree{std::numbers::pi / 180.0};

void add_step_options(CLI::App& command, DepthFilterConfig& filter) {
  add_choice(command, "--method", filter.method, kDepthFilterMethodNames,
             "surface keeps what lies on a surface; thesis removes all that may be wrong");
  command.add_option("--baseline", filter.baseline_m, "from the camera to the infrared emitter, metres")
      ->type_name("METRES")
      ->capture_default_str();
  add_choice(command, "--emitter", filter.emitter_side, kEmitterSideNames,
             "the emitter's side in the image; shadows fall to the other side (right where the driver mirrors images)");
  command
      .add_option_function<double>(
          "--veil-angle", [&filter](const double& angle_deg) { filter.veil_angle_rad = angle_deg * kRadPerDegree; },
          "a point with a neighbour so nearly behind or before it is a veil point, degrees (default: 10)")
      ->type_name("DEGREES");
  constexpr std::array<std::string_view, 2> kSteps{"shadow", "veil"};
  const auto only = [&filter](const std::string& step) {
    filter.remove_shadow_points = step == "shadow";
    filter.remove_veil_points = step == "veil";
  };
  add_words(command, "--only", kSteps, only, "do only one of the two steps");
}

}  // namespace

void add_filter_options(CLI::App& command, FilterOptions& options) {
  command.add_option("frames", options.frames, "depth images in 16-bit PNG; a folder stands for those in it")
      ->required()
      ->type_name("FRAMES...");
  command
      .add_option("--out", options.out,
                  "folder for the filtered frames, of the same names, filter.json, and pictures before and after")
      ->required()
      ->type_name("DIR");
  add_camera_options(command, options.camera_options, false);
  command.add_option("--depth-scale", options.encoding.units_per_m, "depth samples per metre")
      ->type_name("UNITS")
      ->capture_default_str();
  add_step_options(command, options.filter);
  command.add_option("--pictures", options.pictures, "pictures of the first so many frames; 0: none")
      ->check(check_whole_number)
      ->type_name("N")
      ->capture_default_str();
  command.add_flag("--force", options.force, "write into a folder that holds other files");
}

void check_filter_options(FilterOptions& options) {
  options.camera = options.camera_options.camera(camera_preset("kinect-v2").value());
  require_ok(options.camera.validate(), "the camera");
  require_positive(options.encoding.units_per_m, "--depth-scale");
  require_ok(options.filter.validate(), "--baseline, --veil-angle");
}

}  // namespace saccade::cli
