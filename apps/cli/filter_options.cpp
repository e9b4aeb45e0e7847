// SPDX-License-Identifier: Apache-2.0
#include "declaration.hpp"
#include "filter.hpp"

namespace saccade::cli {
namespace {

void declare_steps(Options& options, DepthFilterConfig& filter) {
  options.choice("--method", filter.method, kDepthFilterMethodNames,
                 "surface keeps the points that lie on a surface; thesis removes every point that may be wrong");
  options.value("--baseline", filter.baseline_m, "METRES", "distance from the camera to the infrared emitter, metres");
  options.choice(
      "--emitter", filter.emitter_side, kEmitterSideNames,
      "the emitter's side in the image; shadows fall to the other side (right where the driver mirrors images)");
  options.angle("--veil-angle", filter.veil_angle_rad,
                "a point with a neighbour so nearly behind or before it is a veil point, degrees");
  constexpr std::array<std::string_view, 2> kSteps{"shadow", "veil"};
  const auto only = [&filter](const std::string& step) {
    filter.remove_shadow_points = step == "shadow";
    filter.remove_veil_points = step == "veil";
  };
  add_words(options.group(), "--only", kSteps, only, "do only one of the two steps");
}

}  // namespace

void declare_filter(Options& declared, FilterOptions& options) {
  declared
      .value("frames", options.frames, "FRAMES...",
             "depth images (16-bit PNG, PGM, TIFF, NPY or EXR), or folders of them")
      .required();
  declared.folder(
      {.help =
           "folder for the filtered frames, PNG files of the same names, filter.json, and pictures before and after",
       .files = {kFilterFile},
       .document = kFilterFile,
       .required = true,
       .opened_by_command = true});
  add_camera_options(declared.group(), options.camera_options, false);
  declared.value("--depth-scale", options.depth_scale, "UNITS",
                 "depth samples per metre, also of the results (default: 1000; floats are metres)");
  declare_steps(declared, options.filter);
  declared.value("--pictures", options.pictures, "N", "draw pictures of the first N frames").whole_number();
  declared.flag("--no-pictures{false}", options.write_pictures, "draw no pictures");
}

void check_filter_options(FilterOptions& options) {
  options.camera = options.camera_options.camera(camera_preset("kinect-v2").value());
  require_ok(options.camera.validate(), "the camera");
  if (options.depth_scale) options.encoding.units_per_m = *options.depth_scale;
  require_positive(options.encoding.units_per_m, "--depth-scale");
  require_ok(options.filter.validate(), "--baseline, --veil-angle");
}

}  // namespace saccade::cli
