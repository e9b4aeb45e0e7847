// SPDX-License-Identifier: Apache-2.0
#pragma once
// Lists the frames of an RGB-D folder with their files. Used by rgbd_folder.cpp.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/io/frames/internal/layout_files.hpp"
#include "saccade/io/frames/rgbd_folder.hpp"

namespace saccade {

/// One of the cameras whose images lie side by side in one image, as RTAB-Map keeps those of several.
struct CameraStrip {
  int camera{0};
  int cameras{1};
};

struct RgbdFrameFiles {
  std::string name;
  std::optional<double> time_s{};
  std::optional<std::filesystem::path> depth{};
  std::optional<std::filesystem::path> color{};
  std::optional<std::filesystem::path> pose_file{};  ///< one matrix
  std::optional<Result<Pose>> T_world_camera{};      ///< from a file with all poses
  std::optional<Result<Intrinsics>> intrinsics{};    ///< where each image has its own
  std::optional<Pose> T_base_camera{};               ///< the camera on the robot whose poses the folder holds
  std::optional<CameraStrip> strip{};                ///< the part of its images that is the frame's
};

struct RgbdListing {
  RgbdLayout layout{RgbdLayout::automatic};
  std::optional<DepthUnits> scale{};       ///< none: it must come from the intrinsics' file or from the caller
  std::optional<Intrinsics> intrinsics{};  ///< set where the layout has its own file for them
  std::string intrinsics_from{};
  bool intrinsics_are_color{false};              ///< they are scaled to the size of the depth images
  std::optional<Intrinsics> color_intrinsics{};  ///< where they differ from those of the depth images
  std::optional<Pose> T_color_depth{};
  std::vector<RgbdFrameFiles> frames{};
  bool has_poses{false};
  std::vector<std::string> notes{};  ///< what was left out, for people
};

/// Row of the table of layouts (rgbd_layout.cpp). Patterns are those of find_files.
struct RgbdLayoutRule {
  using Patterns = std::vector<std::string_view>;
  using Complete = Status (*)(const std::filesystem::path& folder, const RgbdLayoutRule& rule,
                              const RgbdFolderConfig& config, RgbdListing& listing);

  RgbdLayout layout;
  std::string_view title;       ///< for messages
  std::vector<Patterns> marks;  ///< a folder is recognised by one pattern of each
  Patterns depth{};             ///< the first pattern that has files counts, here and below; '#' is the frame
  Patterns color{};
  Patterns pose_each{};   ///< a matrix per frame
  Patterns pose_list{};   ///< all poses in one file
  Patterns intrinsics{};  ///< before the files that any layout may have
  std::optional<DepthEncoding> encoding{};
  Complete complete{nullptr};  ///< reads what only this layout has
};

/// Returns all frames in order, with the poses of `poses_file` or of the folder. Answers not_found without any frame,
/// naming the nearest layout and what is missing from it.
[[nodiscard]] Result<RgbdListing> list_rgbd_folder(const std::filesystem::path& folder, const RgbdFolderConfig& config);

// Complete a listing by what one layout has of its own (layout_indices.cpp, layout_rtabmap.cpp, azure_kinect.cpp).
Status complete_princeton(const std::filesystem::path& folder, const RgbdLayoutRule& rule,
                          const RgbdFolderConfig& config, RgbdListing& listing);
Status complete_bop(const std::filesystem::path& folder, const RgbdLayoutRule& rule, const RgbdFolderConfig& config,
                    RgbdListing& listing);
Status complete_bundlefusion(const std::filesystem::path& folder, const RgbdLayoutRule& rule,
                             const RgbdFolderConfig& config, RgbdListing& listing);
Status complete_sun3d(const std::filesystem::path& folder, const RgbdLayoutRule& rule, const RgbdFolderConfig& config,
                      RgbdListing& listing);
Status complete_scannet(const std::filesystem::path& folder, const RgbdLayoutRule& rule, const RgbdFolderConfig& config,
                        RgbdListing& listing);
Status complete_rtabmap(const std::filesystem::path& folder, const RgbdLayoutRule& rule, const RgbdFolderConfig& config,
                        RgbdListing& listing);
Status complete_open3d(const std::filesystem::path& folder, const RgbdLayoutRule& rule, const RgbdFolderConfig& config,
                       RgbdListing& listing);
Status complete_tum(const std::filesystem::path& folder, const RgbdLayoutRule& rule, const RgbdFolderConfig& config,
                    RgbdListing& listing);
Status complete_associations(const std::filesystem::path& folder, const RgbdLayoutRule& rule,
                             const RgbdFolderConfig& config, RgbdListing& listing);

/// Gives the frames the poses of a list, and notes what is left over (layout_poses.cpp): by id; by time; by order where
/// there are as many poses as frames; else by the number in the frame's name.
/// @return not_found for an empty list; size_mismatch where nothing says which pose belongs to which frame.
Status attach_pose_file(RgbdListing& listing, const std::filesystem::path& path, const RgbdFolderConfig& config);
/// Gives the frames the poses of the files of a layout: the first of them; of several cameras (layout_rtabmap.cpp),
/// that of each camera, or else the robot's.
Status attach_pose_lists(RgbdListing& listing, const std::vector<KeyedFile>& lists, const RgbdFolderConfig& config);

/// Answers unsupported where poses of RTAB-Map's robot cannot be told from those of its camera: only poses with an id
/// are surely the robot's, and a file named after the camera has the camera's.
[[nodiscard]] Result<bool> are_poses_of_robot(const RgbdListing& listing, const std::filesystem::path& path,
                                              bool have_ids);

/// Tells whether a folder itself has a file with intrinsics that any layout may have (folder_camera.cpp).
[[nodiscard]] bool has_intrinsics_file(const std::filesystem::path& folder);
/// Finds intrinsics (folder_camera.cpp): the given ones, with the scale of the folder's; those of the layout; those of
/// single images; or those of a file beside the frames. Answers not_found with what to do.
Status find_intrinsics(const std::filesystem::path& folder, const RgbdFolderConfig& config, RgbdListing& listing);
/// Chooses the scale: the given one, that of the intrinsics' file, or the layout's. Answers invalid_argument without.
[[nodiscard]] Result<DepthUnits> find_units(const std::filesystem::path& folder, const RgbdFolderConfig& config,
                                            const RgbdListing& listing);

/// Returns "1 image" or "2 images".
[[nodiscard]] std::string counted(std::size_t count, std::string_view one, std::string_view many);

}  // namespace saccade
