// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <numbers>

#include "options.hpp"
#include "segment.hpp"

namespace saccade::cli {
namespace {

constexpr double kDegree_rad{std::numbers::pi / 180.0};

void add_supervoxel_options(CLI::App& command, SegmentOptions& options) {
  SupervoxelConfig& supervoxels = options.supervoxels;
  command.add_option("--voxel-size", supervoxels.voxels.voxel_size_m, "edge of the voxels, metres")
      ->type_name("METRES")
      ->capture_default_str();
  command.add_option("--seed-size", supervoxels.seed_spacing_m, "between the seeds of supervoxels, metres")
      ->type_name("METRES")
      ->capture_default_str();
  command.add_option("--spatial-weight", supervoxels.spatial_weight, "of the distance from a supervoxel's centre")
      ->type_name("WEIGHT")
      ->capture_default_str();
  command.add_option("--normal-weight", supervoxels.normal_weight, "of the angle between normals")
      ->type_name("WEIGHT")
      ->capture_default_str();
  command.add_option("--color-weight", supervoxels.color_weight, "of the difference of colours, where there are any")
      ->type_name("WEIGHT")
      ->capture_default_str();
  command.add_flag("--transform,!--no-transform", supervoxels.voxels.single_camera,
                   "the cloud is one camera's, in its frame (z forwards): voxels grow with depth");
  command
      .add_option_function<std::string>(
          "--viewpoint",
          [&options](const std::string& text) { options.viewpoint_m = parse_point("--viewpoint", text); },
          "estimated normals turn towards it (default: the viewpoint in a PCD file, else the origin)")
      ->type_name("X,Y,Z");
}

void add_lccp_options(CLI::App& command, LccpConfig& lccp) {
  command
      .add_option_function<double>(
          "--concavity", [&lccp](const double& angle_deg) { lccp.concavity_tolerance_rad = angle_deg * kDegree_rad; },
          "surfaces that bend inwards by less count as convex, degrees (default: 10)")
      ->type_name("DEGREES");
  command.add_option("--smoothness", lccp.smoothness, "step between supervoxels that is allowed, in voxels")
      ->type_name("VOXELS")
      ->capture_default_str();
  command.add_flag("--sanity,!--no-sanity", lccp.sanity, "keep apart what touches at a corner only (default: on)");
  command.add_flag("--extended,!--no-extended", lccp.extended_convexity,
                   "a convex edge needs a third supervoxel with convex edges to both (default: off)");
  command.add_option("--min-size", lccp.min_supervoxels, "segments of fewer supervoxels join a neighbour")
      ->check(check_whole_number)
      ->type_name("N")
      ->capture_default_str();
}

void check_extensions(const SegmentOptions& options) {
  const std::filesystem::path extension = options.out.extension();
  if (!options.out.empty() && extension != ".pcd" && extension != ".ply") {
    usage_error("--out", "needs a name that ends in .pcd or .ply, not '" + options.out.string() + "'");
  }
  if (!options.picture.empty() && options.picture.extension() != ".png") {
    usage_error("--picture", "needs a name that ends in .png, not '" + options.picture.string() + "'");
  }
}

}  // namespace

void add_segment_options(CLI::App& command, SegmentOptions& options) {
  command.add_option("input", options.input, "a point cloud (PCD, PLY, text, KITTI .bin), or a saved map (.sacmap)")
      ->required()
      ->type_name("CLOUD|MAP");
  command.add_option("--method", options.method, "how: lccp, supervoxels joined where surfaces bend outwards")
      ->type_name("NAME")
      ->capture_default_str();
  command
      .add_option("--out", options.out,
                  "the cloud with a field label more: 1, 2, ... by segment, 0 for no point; PCD, or PLY by its name")
      ->type_name("FILE");
  command.add_option("--picture", options.picture, "PNG of the segments and of their saliency")->type_name("FILE");
  add_supervoxel_options(command, options);
  add_lccp_options(command, options.lccp);
  add_saliency_options(command, options.saliency);
  command
      .add_option("--isolation-distance", options.measures.isolation_distance_m,
                  "a point is isolated where no other segment is so near, metres")
      ->type_name("METRES")
      ->capture_default_str();
}

void check_segment_options(SegmentOptions& options) {
  if (options.method != "lccp") usage_error("--method", "must be lccp, not '" + options.method + "'");
  check_extensions(options);
  require_positive(options.supervoxels.voxels.voxel_size_m, "--voxel-size");
  require_positive(options.supervoxels.seed_spacing_m, "--seed-size");
  require_ok(options.supervoxels.validate(), "--seed-size, --spatial-weight, --normal-weight, --color-weight");
  require_ok(options.lccp.validate(), "--concavity, --smoothness");
  require_ok(options.measures.validate(), "--isolation-distance");
  if (is_map(options.input) && options.supervoxels.voxels.single_camera) {
    usage_error("--transform", "is for the cloud of one camera in its frame; a map is in the world's");
  }
  check_saliency_options(options.saliency, options.supervoxels.voxels.single_camera);
}

}  // namespace saccade::cli
