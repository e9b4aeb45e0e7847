// SPDX-License-Identifier: Apache-2.0
#include "fuse_options.hpp"

#include "declaration.hpp"
#include "length_options.hpp"
#include "size_options.hpp"

namespace saccade::cli {

void declare_fuse(Options& declared, FuseOptions& options) {
  add_frame_options(declared.group(), options);
  declared.value("--voxel-size", options.map.voxel_size_m, "METRES", "edge of a voxel, metres");
  declared.value("--truncation", options.map.truncation_vox, "VOXELS", "truncation distance, voxels");
  add_clearing_option(declared.group(), options.map.clearing_percent);
  declared.box("--workspace", options.map.workspace, "box outside of which nothing counts as unknown");
  declared.flag("--no-color{false}", options.map.color, "do not fuse colours");
  declared.value("--continue", options.continue_map, "MAP", "go on with a saved map");
  add_size(declared.group(), "--map-memory", options.map_memory_bytes,
           "most memory for the map; what does not fit is paged out to the disk (512MiB, 2GiB)");
  declared.value("--moving-volume", options.moving_volume_m, "METRES",
                 "edge of a cube that moves with the camera; the map outside is paged out to the disk");
  declared.value("--page-folder", options.page_folder, "DIR",
                 "folder for what is paged out (default: that of --out); it is gone when the program ends");
  declared.choice("--loops", options.loops, kLoopModeNames,
                  "close loops of tracked poses, and fuse again along the corrected ones: after the run, or beside it");
  declared.choice("--backend", options.backend, kComputeBackendNames,
                  "where frames are tracked: the map's ray cast, and ICP but for --tracking rgbd; poses stay the same");
  declared.flag("--no-mesh{false}", options.write_mesh, "do not extract the mesh");
  declared.flag("--no-pictures{false}", options.write_pictures, "draw no pictures");
}

void check_fuse_options(FuseOptions& options) {
  if (!options.map.color) options.folder.read_color = false;
  require_positive(options.map.voxel_size_m, "--voxel-size");
  require_positive(options.map.truncation_vox, "--truncation");
  require_ok(options.map.validate(), "--voxel-size, --truncation, --clearing");
  if (options.backend == ComputeBackend::cuda && options.is_paged()) {
    usage_error("--backend", "a GPU holds the map that lies in memory; leave out --map-memory and --moving-volume");
  }
  if (options.moving_volume_m) require_length(*options.moving_volume_m, "--moving-volume");
  if (!options.page_folder.empty() && !options.is_paged()) {
    usage_error("--page-folder", "is for --map-memory and --moving-volume");
  }
  check_frame_options(options);
  if (options.loops != LoopMode::off && !options.continue_map.empty()) {
    usage_error("--loops", "the frames of a saved map are not there to be fused again; leave out --continue");
  }
  if (!options.continue_map.empty() && options.map_size_given) {
    usage_error("--continue", "a saved map keeps its voxel size, truncation and clearing; leave those options out");
  }
}

}  // namespace saccade::cli
