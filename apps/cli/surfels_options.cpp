// SPDX-License-Identifier: Apache-2.0
#include "surfels_options.hpp"

#include "add_value.hpp"

#include <CLI/CLI.hpp>
#include <cmath>

namespace saccade::cli {
namespace {

/// Refuses options that a run without the mode filter, or with surfels at their averages, would ignore.
void check_options_have_effect(const CLI::App& command, const SurfelsOptions& options) {
  if (!options.filtered()) {
    for (const char* name : {"--choice", "--places", "--max-modes", "--max-depth-change"}) {
      if (command.count(name) > 0) usage_error(name, "has no meaning with --mode-filter off");
    }
  }
  if (!options.places_of_modes() && command.count("--max-depth-change") > 0) {
    usage_error("--max-depth-change", "needs --places modes: averages are of depths as they were measured");
  }
}

/// Applies --as-printed to what was not named.
void follow_the_thesis(const CLI::App& command, SurfelsOptions& options) {
  if (!options.filtered()) usage_error("--as-printed", "has no meaning with --mode-filter off");
  const ModeFilterConfig printed = ModeFilterConfig::as_printed();
  if (command.count("--choice") == 0) options.choice = ModeChoice::heaviest;
  if (!options.places) options.places = SurfelPlaces::modes;
  if (command.count("--max-depth-change") == 0) options.filter.max_depth_change_m = printed.max_depth_change_m;
}

}  // namespace

void add_surfels_options(CLI::App& command, SurfelsOptions& options) {
  add_frame_options(command, options);
  add_value(command, "--out", options.out, "CLOUD",
            "surfels with normals, radius, colour and confidence: PLY, or PCD for a name that ends in .pcd")
      ->required();
  add_choice(command, "--mode-filter", options.mode_filter, kModeFilterUseNames,
             "on: of each surfel's colours one that was seen, not a blend; off: averages; both: averages, too, in "
             "NAME.average.EXT beside --out");
  add_choice(command, "--track-against", options.track_against, kTrackedSurfaceNames,
             "surface that --tracking rgbd aligns frames to: the surfels, or a TSDF map of the same frames");
  add_choice(
      command, "--loops", options.loops, kSurfelLoopNames,
      "end: close the loops of tracked poses after the run, and fuse all surfels again along the corrected ones");
  add_value(command, "--image-sigma", options.fusion.image_sigma, "SIGMA",
            "width of the weight of pixels around the image's centre: smaller for strong vignetting");
  add_choice(command, "--exposure-compensation", options.exposure_compensation, kOnOff,
             "on: for cameras with automatic gain or exposure: colours of each frame are brought to those of the "
             "first; vignetting must be corrected");
  add_value(command, "--max-modes", options.filter.max_modes, "N", "colours that a surfel remembers, 1 to 32");
  add_choice(command, "--choice", options.choice, kModeChoiceNames,
             "colour of a surfel in the end: the colour that is densest in its place more than around, where its own "
             "colours are densest, or the heaviest one (thesis, eq. 4.11)");
  add_choice(command, "--places", options.places, kSurfelPlacesNames,
             "place of a surfel: the average of its measurements, or the place of its modes, with depths guided by "
             "colour as in the thesis (default: average; with --choice heaviest modes)");
  add_value(command, "--max-depth-change", options.filter.max_depth_change_m, "METRES",
            "with --places modes: a depth that the guided filter would move farther stays as it was measured; inf: all "
            "move, as in the thesis");
  command.add_flag("--as-printed", options.as_printed,
                   "the mode filter to the letter of the thesis: --choice heaviest --places modes --max-depth-change "
                   "inf, where they are not given");
  add_value(command, "--min-confidence", options.min_confidence, "W",
            "surfels that were seen less, by the sum of their observations' weights, are not written: often they are "
            "no surfaces; 0: all are (default: 10, or a twentieth of the number of frames if that is less)");
  add_value(command, "--picture", options.picture, "FILE",
            "PNG of the surfels as the frame in the middle saw them; with --mode-filter both side by side");
}

void check_surfels_options(const CLI::App& command, SurfelsOptions& options) {
  check_frame_options(options);
  if (command.count("--track-against") > 0 && options.tracking != TrackingMode::rgbd) {
    usage_error("--track-against", "needs --tracking rgbd; icp and hint track against a TSDF map");
  }
  const std::string extension = options.out.extension().string();
  if (extension != ".ply" && extension != ".pcd") usage_error("--out", "must end in .ply or .pcd");
  if (options.as_printed) follow_the_thesis(command, options);
  check_options_have_effect(command, options);
  if (!options.picture.empty() && options.picture.extension() != ".png") {
    usage_error("--picture", "needs a name that ends in .png, not '" + options.picture.string() + "'");
  }
  if (options.min_confidence && !(*options.min_confidence >= 0.0 && std::isfinite(*options.min_confidence))) {
    usage_error("--min-confidence", "must be 0 or more");
  }
  require_ok(options.fusion.validate(), "--image-sigma");
  if (!(options.filter.max_depth_change_m > 0.0)) usage_error("--max-depth-change", "must be positive");
  options.filter.enhance_depth = options.places_of_modes();
  if (options.choice != ModeChoice::sharpened) options.filter.sharpening.strength = 0.0;
  if (options.choice == ModeChoice::heaviest) options.filter.choice_sigmas = 0.0;
  require_ok(options.filter.validate(), "--max-modes");
}

}  // namespace saccade::cli
