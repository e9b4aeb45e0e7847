// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

#include "saccade/core/angle.hpp"

#include "add_value.hpp"
#include "filter.hpp"

namespace saccade::cli {
namespace {

void add_step_options(CLI::App& command, DepthFilterConfig& filter) {
  add_choice(command, "--method", filter.method, kDepthFilterMethodNames,
             "surface keeps what lies on a surface; thesis removes all that may be wrong");
  add_value(command, "--baseline", filter.baseline_m, "METRES", "from the camera to the infrared emitter, metres");
  add_choice(command, "--emitter", filter.emitter_side, kEmitterSideNames,
             "the emitter's side in the image; shadows fall to the other side (right where the driver mirrors images)");
  command
      .add_option_function<double>(
          "--veil-angle", [&filter](const double& angle_deg) { filter.veil_angle_rad = angle_deg * 1_deg; },
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
  add_value(command, "frames", options.frames, "FRAMES...",
            "depth images in 16-bit PNG; a folder stands for those in it")
      ->required();
  add_value(command, "--out", options.out, "DIR",
            "folder for the filtered frames, of the same names, filter.json, and pictures before and after")
      ->required();
  add_camera_options(command, options.camera_options, false);
  add_value(command, "--depth-scale", options.encoding.units_per_m, "UNITS", "depth samples per metre");
  add_step_options(command, options.filter);
  add_value(command, "--pictures", options.pictures, "N", "pictures of the first so many frames; 0: none")
      ->check(check_whole_number);
  command.add_flag("--force", options.force, "write into a folder that holds other files");
}

void check_filter_options(FilterOptions& options) {
  options.camera = options.camera_options.camera(camera_preset("kinect-v2").value());
  require_ok(options.camera.validate(), "the camera");
  require_positive(options.encoding.units_per_m, "--depth-scale");
  require_ok(options.filter.validate(), "--baseline, --veil-angle");
}

}  // namespace saccade::cli
