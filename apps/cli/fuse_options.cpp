// SPDX-License-Identifier: Apache-2.0
#include "fuse_options.hpp"

#include "add_value.hpp"

#include <CLI/CLI.hpp>

namespace saccade::cli {
namespace {

void add_map_options(CLI::App& command, FuseOptions& options) {
  add_value(command, "--voxel-size", options.map.voxel_size_m, "METRES", "edge of a voxel, metres");
  add_value(command, "--truncation", options.map.truncation_vox, "VOXELS", "truncation distance, voxels");
  add_clearing_option(command, options.map.clearing_percent);
  add_box(command, "--workspace", options.map.workspace, "box outside of which nothing counts as unknown");
  command.add_flag("--no-color{false}", options.map.color, "do not fuse colours");
  add_value(command, "--continue", options.continue_map, "MAP", "go on with a saved map");
}

}  // namespace

void add_fuse_options(CLI::App& command, FuseOptions& options) {
  add_value(command, "--out", options.out, "RUN", "folder for the results; made if it is not there")->required();
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
