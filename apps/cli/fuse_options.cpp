// SPDX-License-Identifier: Apache-2.0
#include "fuse_options.hpp"

#include <CLI/CLI.hpp>

namespace saccade::cli {
namespace {

void add_map_options(CLI::App& command, FuseOptions& options) {
  command.add_option("--voxel-size", options.map.voxel_size_m, "edge of a voxel, metres")
      ->type_name("METRES")
      ->capture_default_str();
  command.add_option("--truncation", options.map.truncation_vox, "truncation distance, voxels")
      ->type_name("VOXELS")
      ->capture_default_str();
  add_clearing_option(command, options.map.clearing_percent);
  add_box(command, "--workspace", options.map.workspace, "box outside of which nothing counts as unknown");
  command.add_flag("--no-color{false}", options.map.color, "do not fuse colours");
  command.add_option("--continue", options.continue_map, "go on with a saved map")->type_name("MAP");
}

}  // namespace

void add_fuse_options(CLI::App& command, FuseOptions& options) {
  command.add_option("--out", options.out, "folder for the results; made if it is not there")
      ->required()
      ->type_name("RUN");
  add_frame_options(command, options);
  add_map_options(command, options);
  command.add_flag("--no-mesh{false}", options.write_mesh, "do not extract the mesh");
  command.add_flag("--no-pictures{false}", options.write_pictures, "draw no pictures");
  command.add_flag("--force", options.force, "write into a folder that holds other files");
}

void check_fuse_options(FuseOptions& options) {
  if (!options.map.color) options.folder.read_color = false;
  require_positive(options.map.voxel_size_m, "--voxel-size");
  require_positive(options.map.truncation_vox, "--truncation");
  require_ok(options.map.validate(), "--voxel-size, --truncation, --clearing");
  check_frame_options(options);
  if (!options.continue_map.empty() && options.map_size_given) {
    usage_error("--continue", "a saved map keeps its voxel size, truncation and clearing; leave those options out");
  }
}

}  // namespace saccade::cli
