// SPDX-License-Identifier: Apache-2.0
#pragma once
// Lists the frames of an RGB-D folder: which files belong to which frame. Used by rgbd_folder.cpp.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "saccade/io/frames/rgbd_folder.hpp"

namespace saccade {

struct RgbdFrameFiles {
  std::string name;
  std::optional<double> time_s;
  std::optional<std::filesystem::path> depth;
  std::optional<std::filesystem::path> color;
  std::optional<std::filesystem::path> pose_file;  ///< one 4×4 matrix
  std::optional<Result<Pose>> T_world_camera;      ///< from a file of all poses
};

struct RgbdListing {
  RgbdLayout layout{RgbdLayout::automatic};
  DepthEncoding encoding;
  std::optional<Intrinsics> intrinsics;  ///< where the layout's own file holds them
  std::string intrinsics_from;
  std::vector<RgbdFrameFiles> frames;
  bool has_poses{false};
};

/// All frames in order, with the poses of `poses_file` or of the folder attached. not_found without any frame.
[[nodiscard]] Result<RgbdListing> list_rgbd_folder(const std::filesystem::path& folder, const RgbdFolderConfig& config);

}  // namespace saccade
