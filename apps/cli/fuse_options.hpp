// SPDX-License-Identifier: Apache-2.0
#pragma once
// FuseOptions: the command line of `saccade fuse`, and what it means for the library.

#include <filesystem>
#include <optional>
#include <string_view>

#include "command.hpp"
#include "options.hpp"
#include "saccade/io/rgbd_folder.hpp"
#include "saccade/map/reconstruction.hpp"
#include "saccade/sensor/gap_filling.hpp"

namespace CLI {
class App;
}

namespace saccade::cli {

struct FuseOptions {
  std::filesystem::path frames;
  std::filesystem::path out;
  std::optional<TrackingMode> tracking;  ///< default: forced where the folder has poses, else icp
  CameraOptions camera;
  RgbdFolderConfig folder;
  std::optional<double> depth_scale;
  std::optional<int> fill_gaps_px;  ///< default: as the first frame needs it
  TsdfConfig map;
  bool map_size_given{false};
  std::filesystem::path continue_map;
  bool write_mesh{true};
  bool write_pictures{true};
  bool force{false};
};

[[nodiscard]] std::string_view to_string(TrackingMode mode);

/// Adds the options to the subcommand; `options` outlives the parsing.
void add_fuse_options(CLI::App& command, FuseOptions& options);
/// What only shows when all options are known; throws usage errors. Completes options.folder and options.map.
void check_fuse_options(FuseOptions& options);

}  // namespace saccade::cli
