// SPDX-License-Identifier: Apache-2.0
#pragma once
// FuseOptions: the command line of `saccade fuse`, and what it means for the library.

#include <cstddef>
#include <filesystem>
#include <optional>

#include "compute_backend.hpp"
#include "frame_options.hpp"
#include "loop_mode.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace CLI {
class App;
}

namespace saccade::cli {

class Options;

/// The map that recorded frames are fused into. Their poses are not exact: docs/decisions/0021-clearing.md.
[[nodiscard]] inline TsdfConfig recorded_map() {
  TsdfConfig map;
  map.clearing_percent = 50;
  return map;
}

struct FuseOptions : FrameOptions {
  TsdfConfig map{recorded_map()};
  bool map_size_given{false};
  std::filesystem::path continue_map;
  LoopMode loops{LoopMode::off};
  ComputeBackend backend{ComputeBackend::cpu};
  bool write_mesh{true};
  bool write_pictures{true};
  std::optional<std::size_t> map_memory_bytes;
  std::optional<double> moving_volume_m;
  std::filesystem::path page_folder;

  [[nodiscard]] bool is_paged() const { return map_memory_bytes || moving_volume_m; }
};

/// Declares the options; they outlive the parsing.
void declare_fuse(Options& declared, FuseOptions& options);
/// Checks the options together, once all are known; throws usage errors. Completes options.folder and options.map.
void check_fuse_options(FuseOptions& options);

}  // namespace saccade::cli
