// SPDX-License-Identifier: Apache-2.0
#include "fuse_options.hpp"

#include "declaration.hpp"

namespace saccade::cli {

void declare_fuse(Options& declared, FuseOptions& options) {
  add_frame_options(declared.group(), options);
  declared.value("--voxel-size", options.map.voxel_size_m, "METRES", "edge of a voxel, metres");
  declared.value("--truncation", options.map.truncation_vox, "VOXELS", "truncation distance, voxels");
  add_clearing_option(declared.group(), options.map.clearing_percent);
  declared.box("--workspace", options.map.workspace, "box outside of which nothing counts as unknown");
  declared.flag("--no-color{false}", options.map.color, "do not fuse colours");
  declared.value("--continue", options.continue_map, "MAP", "go on with a saved map");
  declared.flag("--no-mesh{false}", options.write_mesh, "do not extract the mesh");
  declared.flag("--no-pictures{false}", options.write_pictures, "draw no pictures");
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
