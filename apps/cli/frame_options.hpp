// SPDX-License-Identifier: Apache-2.0
#pragma once
// FrameOptions: which RGB-D frames a command reads, and where their poses come from; open_frames.

#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include "command.hpp"
#include "options.hpp"
#include "saccade/io/bags/bags.hpp"
#include "saccade/io/frames/rgbd_folder.hpp"
#include "saccade/sensor/gap_filling.hpp"
#include "saccade/tracking/reconstruction.hpp"

namespace CLI {
class App;
}

namespace saccade::cli {

struct FrameOptions {
  std::filesystem::path frames;
  std::optional<TrackingMode> tracking;  ///< default: forced where the folder has poses, else icp
  CameraOptions camera;
  RgbdFolderConfig folder;
  BagFramesConfig bag;  ///< topics and frames alone; empty where frames are a folder
  std::optional<double> depth_scale;
  std::optional<int> fill_gaps_px;  ///< default: as the first frame needs it
};

/// Adds the options to the subcommand; `options` outlives the parsing.
void add_frame_options(CLI::App& command, FrameOptions& options);
/// Checks the options together, once all are known; throws usage errors. Completes options.folder.
void check_frame_options(FrameOptions& options);

/// Fails where a file that is to be written is one of those that are read: a mask, poses, or what lies in the folder.
[[nodiscard]] Status check_beside_frames(const FrameOptions& options, const std::filesystem::path& file,
                                         const char* option);

struct OpenFrames {
  std::unique_ptr<RgbdFolderSource> source;
  RgbdFolderConfig folder;  ///< that the source was opened with
  TrackingMode tracking{TrackingMode::icp};
};

/// ICP alone needs no poses: a bad one is then no reason to leave a frame out.
[[nodiscard]] Result<OpenFrames> open_frames(const FrameOptions& options);

/// Adds warnings: what was left out of a folder, and that a bag is cut or damaged and was read as far as it goes.
void warn_of_damage(const std::filesystem::path& frames, const RgbdFolderInfo& info, Outcome& outcome);

}  // namespace saccade::cli
