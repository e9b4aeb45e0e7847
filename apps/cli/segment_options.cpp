// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cmath>
#include <sstream>

#include "declaration.hpp"
#include "saccade/core/angle.hpp"
#include "saccade/segment/live_segments.hpp"
#include "segment.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;

std::string brief(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

void add_supervoxel_options(CLI::App& command, SegmentOptions& options) {
  SupervoxelConfig& supervoxels = options.supervoxels;
  add_value(command, "--voxel-size", supervoxels.voxels.voxel_size_m, "METRES",
            "edge of the voxels, metres (sv-lccp: 0.01; for a map: the nearest of 1, 2, 4 and 8 of its voxels)");
  add_value(
      command, "--seed-size", supervoxels.seed_spacing_m, "METRES",
      "distance between the seeds of supervoxels, metres (sv-lccp: 0.05; for a map: as many voxels as for clouds)");
  add_value(command, "--spatial-weight", supervoxels.spatial_weight, "WEIGHT",
            "weight of the distance from a supervoxel's centre (sv-lccp: 0.1)");
  add_value(command, "--normal-weight", supervoxels.normal_weight, "WEIGHT",
            "weight of the angle between normals (sv-lccp, flood-fill: 0.5)");
  add_value(command, "--color-weight", supervoxels.color_weight, "WEIGHT",
            "weight of the difference in colour, for clouds with colours (sv-lccp, flood-fill: 1)");
  add_value(command, "--rounds", supervoxels.rounds, "COUNT",
            "rounds of growth; before each but the first, supervoxels move to the means of their voxels (sv-lccp: 5)");
  command.add_flag("--transform,!--no-transform", supervoxels.voxels.single_camera,
                   "the cloud is one camera's, in its frame (z forwards): voxels grow with depth");
  add_point(command, "--viewpoint", options.viewpoint_m,
            "estimated normals turn towards it (default: the viewpoint in a PCD file, else the origin)");
}

void add_lccp_options(CLI::App& command, LccpConfig& lccp) {
  command
      .add_option_function<double>(
          "--concavity", [&lccp](const double& angle_deg) { lccp.concavity_tolerance_rad = angle_deg * 1_deg; },
          "surfaces that bend inwards by less count as convex, degrees (default: 10)")
      ->type_name("DEGREES");
  add_value(command, "--smoothness", lccp.smoothness, "VOXELS", "step between supervoxels that is allowed, in voxels");
  command.add_flag("--sanity,!--no-sanity", lccp.sanity, "keep apart what touches at a corner only (default: on)");
  command.add_flag("--extended,!--no-extended", lccp.extended_convexity,
                   "a convex edge needs a third supervoxel with convex edges to both (default: off)");
  add_value(command, "--min-size", lccp.min_supervoxels, "N", "segments of fewer supervoxels join a neighbour")
      ->check(check_whole_number);
}

void add_surfel_options(CLI::App& command, SegmentOptions& options) {
  add_value(command, "--threshold", options.threshold, "DIFFERENCE",
            "flood-fill: surfels that touch and differ by less join one segment (default: " +
                brief(FloodFillConfig{}.threshold) +
                "); sv-lccp: supervoxels whose colours differ by more are kept apart (default: " +
                brief(SvLccpConfig{}.max_color_difference) + ")");
  add_value(command, "--radius", options.truth.radius_m, "METRES",
            "radius of all surfels, metres (default: the cloud's field radius, else from the distance to neighbours)");
  add_value(command, "--list-from", options.list_from, "N",
            "points of the smallest segment in the JSON result (default: 1; flood-fill: 10)")
      ->check(check_whole_number);
  add_value(command, "--curve", options.curve_truth, "TRUTH",
            "a cloud of the same points with true labels: flood-fill and sv-lccp are scored at many thresholds");
  command
      .add_option_function<std::string>(
          "--thresholds",
          [&options](const std::string& text) { options.curve_thresholds = parse_numbers("--thresholds", text, 0); },
          "thresholds of the curve (default: 25 from 0.002 to 1)")
      ->type_name("A,B,...");
  add_truth_options(command, options.truth);
}

std::vector<double> default_thresholds() {
  constexpr int kCount{25};
  constexpr double kLeast{0.002};
  std::vector<double> thresholds;
  for (int i = 0; i < kCount; ++i) thresholds.push_back(std::pow(kLeast, 1.0 - static_cast<double>(i) / (kCount - 1)));
  return thresholds;
}

void refuse(const CLI::App& command, SegmentMethod method, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (command.count(name) == 0) continue;
    usage_error(name, "has no meaning with --method " + std::string{kSegmentMethodNames.of(method)});
  }
}

/// Applies --as-printed to what was not named.
void follow_the_thesis(const CLI::App& command, SegmentOptions& options) {
  if (options.method == SegmentMethod::lccp) {
    usage_error("--as-printed", "is for --method sv-lccp and flood-fill, which the thesis uses with surfels");
  }
  if (options.fills()) {
    options.flood_fill.unknown_is_alike = FloodFillConfig::as_printed().unknown_is_alike;
    return;
  }
  const SvLccpConfig printed = SvLccpConfig::as_printed();
  SupervoxelConfig& own = options.supervoxels;
  if (command.count("--rounds") == 0) own.rounds = printed.supervoxels.rounds;
  own.seeds_settle = printed.supervoxels.seeds_settle;
  own.min_seed_share = printed.supervoxels.min_seed_share;
  own.reach = printed.supervoxels.reach;
  own.moves_in_growth = printed.supervoxels.moves_in_growth;
  own.opposite_is_alike = printed.supervoxels.opposite_is_alike;
  if (command.count("--sanity") == 0) options.lccp.sanity = printed.lccp.sanity;
  options.lccp.smooth = printed.lccp.smooth;
}

/// Refuses options that the method has no use for, and sets the method's own defaults.
void apply_method(const CLI::App& command, SegmentOptions& options) {
  if (options.method == SegmentMethod::lccp) refuse(command, options.method, {"--threshold", "--radius", "--curve"});
  if (options.curve_truth.empty()) {
    for (const char* name : {"--thresholds", "--tolerance", "--no-split"}) {
      if (command.count(name) > 0) usage_error(name, "needs --curve TRUTH");
    }
  }
  if (options.method == SegmentMethod::sv_lccp) {
    if (command.count("--radius") > 0 && options.curve_truth.empty()) usage_error("--radius", "needs --curve TRUTH");
    const SupervoxelConfig defaults = SvLccpConfig{}.supervoxels;
    SupervoxelConfig& own = options.supervoxels;
    if (command.count("--voxel-size") == 0) own.voxels.voxel_size_m = defaults.voxels.voxel_size_m;
    if (command.count("--seed-size") == 0) own.seed_spacing_m = defaults.seed_spacing_m;
    if (command.count("--spatial-weight") == 0) own.spatial_weight = defaults.spatial_weight;
    if (command.count("--normal-weight") == 0) own.normal_weight = defaults.normal_weight;
    if (command.count("--color-weight") == 0) own.color_weight = defaults.color_weight;
    if (command.count("--rounds") == 0) own.rounds = defaults.rounds;
    options.max_color_difference = options.threshold.value_or(options.max_color_difference);
  }
  if (options.fills()) {
    refuse(command, options.method,
           {"--voxel-size", "--seed-size", "--spatial-weight", "--rounds", "--concavity", "--smoothness", "--sanity",
            "--extended", "--min-size"});
    FloodFillConfig& fill = options.flood_fill;
    if (command.count("--normal-weight") > 0) fill.normal_weight = options.supervoxels.normal_weight;
    if (command.count("--color-weight") > 0) fill.color_weight = options.supervoxels.color_weight;
    fill.threshold = options.threshold.value_or(fill.threshold);
    options.supervoxels = {.voxels = {.single_camera = options.supervoxels.voxels.single_camera}};
    constexpr std::size_t kListFrom{10};
    if (command.count("--list-from") == 0) options.list_from = kListFrom;
  }
  if (options.as_printed) follow_the_thesis(command, options);
  if (options.curve_thresholds.empty()) options.curve_thresholds = default_thresholds();
}

bool is_cloud_name(const fs::path& out) { return out.extension() == ".pcd" || out.extension() == ".ply"; }

void check_outputs(const fs::path& out, const SegmentOptions& options) {
  std::error_code ignored;
  if (out.has_extension() && !is_cloud_name(out) && !fs::is_directory(out, ignored)) {
    usage_error("--out", "needs a folder, or a name that ends in .pcd or .ply, not '" + out.string() + "'");
  }
  if (!options.write_pictures && !is_segment_folder(out)) usage_error("--no-pictures", "needs a folder with --out");
  if (!options.picture.empty() && options.picture.extension() != ".png") {
    usage_error("--picture", "needs a name that ends in .png, not '" + options.picture.string() + "'");
  }
}

}  // namespace

Status fit_to_map(double map_voxel_size_m, SegmentOptions& options) {
  if (options.fills()) return {};
  SupervoxelConfig& own = options.supervoxels;
  const double seed_spacing_vox = own.seed_spacing_m / own.voxels.voxel_size_m;
  if (!options.has_voxel_size) {
    MapSegmentsConfig wanted;
    wanted.voxel_size_m = own.voxels.voxel_size_m;
    own.voxels.voxel_size_m = wanted.supervoxels(map_voxel_size_m).voxels.voxel_size_m;
    if (!options.has_seed_size) own.seed_spacing_m = seed_spacing_vox * own.voxels.voxel_size_m;
  }
  if (own.seed_spacing_m >= own.voxels.voxel_size_m) return {};
  return Error{Errc::invalid_argument,
               "seeds of " + brief(own.seed_spacing_m) + " m are closer than the voxels of " +
                   brief(own.voxels.voxel_size_m) + " m; pass a larger --seed-size, or a smaller --voxel-size",
               options.input.string()};
}

bool is_segment_folder(const fs::path& out) {
  std::error_code ignored;
  return !out.empty() && (!is_cloud_name(out) || fs::is_directory(out, ignored));
}

void declare_segment(Options& declared, SegmentOptions& options) {
  CLI::App& command = declared.group();
  declared
      .value("input", options.input, "CLOUD|MAP",
             "a point cloud (PCD, PLY, text, KITTI .bin), or a saved map (.sacmap)")
      .required();
  declared.choice("--method", options.method, kSegmentMethodNames,
                  "how: lccp, supervoxels joined where surfaces bend outwards; sv-lccp, the same kept apart by "
                  "colours; flood-fill, surfels that touch and look alike");
  declared.folder({.value = "DIR|FILE",
                   .help = "the cloud with a further field label: 1, 2, ... by segment, 0 for no point. FILE.pcd or "
                           "FILE.ply: this file alone; a folder: segments.ply, segments.png, segment.json and the "
                           "page report.html",
                   .files = {kSegmentFiles.begin(), kSegmentFiles.end()},
                   .document = kSegmentJson,
                   .opened_by_command = true});
  declared.value("--picture", options.picture, "FILE", "PNG of the segments and of their saliency");
  declared.flag("--no-pictures{false}", options.write_pictures, "draw no picture into the folder of --out");
  declared.flag("--as-printed", options.as_printed,
                "sv-lccp, flood-fill: to the letter of the thesis, where no option says otherwise; supervoxels and "
                "LCCP as PCL has them where nothing is set, and unknown normals that separate");
  add_supervoxel_options(command, options);
  add_lccp_options(command, options.lccp);
  add_surfel_options(command, options);
  add_saliency_options(command, options.saliency);
  add_value(command, "--isolation-distance", options.measures.isolation_distance_m, "METRES",
            "a point is isolated if no other segment is within this distance, metres");
}

void check_segment_options(const CLI::App& command, const fs::path& out, SegmentOptions& options) {
  options.has_voxel_size = command.count("--voxel-size") > 0;
  options.has_seed_size = command.count("--seed-size") > 0;
  apply_method(command, options);
  check_outputs(out, options);
  require_positive(options.supervoxels.voxels.voxel_size_m, "--voxel-size");
  require_positive(options.supervoxels.seed_spacing_m, "--seed-size");
  require_ok(options.supervoxels.validate(),
             "--seed-size, --spatial-weight, --normal-weight, --color-weight, --rounds");
  require_ok(options.lccp.validate(), "--concavity, --smoothness");
  require_ok(options.flood_fill.validate(), "--threshold, --normal-weight, --color-weight");
  for (const double threshold : options.curve_thresholds) {
    if (!(threshold >= 0.0)) usage_error("--thresholds", "must not be negative");
  }
  if (!(options.max_color_difference >= 0.0)) usage_error("--threshold", "must not be negative");
  check_truth_options(options.truth);
  require_ok(options.measures.validate(), "--isolation-distance");
  if (is_map(options.input) && options.supervoxels.voxels.single_camera) {
    usage_error("--transform", "is for the cloud of one camera in its frame; a map is in the world's");
  }
  check_saliency_options(options.saliency, options.supervoxels.voxels.single_camera);
}

}  // namespace saccade::cli
