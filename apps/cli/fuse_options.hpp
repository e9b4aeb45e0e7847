// SPDX-License-Identifier: Apache-2.0
#pragma once
// FuseOptions: the command line of `saccade fuse`, and what it means for the library.

#include <filesystem>

#include "frame_options.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace CLI {
class App;
}

namespace saccade::cli {

class Options;

struct FuseOptions : FrameOptions {
  /// Recorded poses are not exact: docs/decisions/0021-clearing.md.
  FuseOptions() { map.clearing_percent = 50; }

  TsdfConfig map;
  bool map_size_given{false};
  std::filesystem::path continue_map;
  bool write_mesh{true};
  bool write_pictures{true};
};

/// Declares the options; they outlive the parsing.
void declare_fuse(Options& declared, FuseOptions& options);
/// Checks the options together, once all are known; throws usage errors. Completes options.folder and options.map.
void check_fuse_options(FuseOptions& options);

}  // namespace saccade::cli
