// SPDX-License-Identifier: Apache-2.0
#pragma once
// Arms from URDF files, and the robots that come with Saccade. Supported elements and their meaning:
// docs/guides/robots.md.

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/arm/arm_model.hpp"

namespace saccade {

/// Name of the link that is the camera's optical frame.
constexpr std::string_view kCameraFrame{"camera_optical_frame"};

struct UrdfConfig {
  std::string base;  ///< first link of the chain; empty: the root
  std::string tip;   ///< flange; empty: the link behind the camera's last joint, otherwise the end of the longest chain
  std::string camera;  ///< optical frame, fixed to the flange; empty: kCameraFrame, or a name ending so, or the flange
  /// Folders of packages by name, for package://NAME/…; others are searched in the URDF's folder and above.
  std::map<std::string, std::filesystem::path> packages;
  /// Folders that hold packages, at any depth, searched next; after them those of ROS_PACKAGE_PATH, and the folders
  /// `share` of AMENT_PREFIX_PATH.
  std::vector<std::filesystem::path> package_paths{};
  double xacro_timeout_s{60.0};        ///< time limit of the program xacro, which expands files that need it
  std::function<bool()> cancelled{};   ///< asked while xacro runs; true ends it
  double default_speed{1.0};           ///< speed of continuous joints without one, rad/s
  double acceleration_time_s{0.5};     ///< time in which joints without an acceleration reach their speed
  bool keep_beyond_tip{true};          ///< bodies fixed beyond the flange belong to the arm
  std::optional<Pose> T_world_base{};  ///< pose of the chain's first link; nullopt: as in the file
  /// Measured pose of the camera's optical frame on the flange; nullopt: as in the file.
  std::optional<Pose> T_flange_camera{};
};

struct UrdfArm {
  ArmModel arm;
  std::vector<std::string> notes;  ///< assumptions and omissions, one sentence each
  /// The notes that matter for the arm's motions: a tip or camera that neither file nor config names, bodies that stand
  /// in for missing ones, improbable lengths.
  std::vector<std::string> choices{};
};

/// Reads a serial arm. Fixed joints are folded into the links. Bodies of branches belong to their link; joints off the
/// chain stand still: at 0, at the nearest limit, or where the joint that they follow puts them. Choices for an open
/// configuration: docs/guides/robots.md. Mesh paths are relative to `folder`. Reads the attribute `acceleration` (or
/// `drake:acceleration`) of <limit>, which URDF itself lacks.
/// A link without <collision> is taken to fill the convex hull of its <visual>.
/// Answers corrupt_data for text that is not a URDF or not a tree, and for senseless limits, axes or lengths; not_found
/// for meshes and packages; invalid_argument for links that do not exist, for several equally likely tips or cameras,
/// and for a T_world_base that is not rigid; unsupported for mimic, planar and floating joints on the chain, and for
/// xacro. The message is one line that names the joint or link.
[[nodiscard]] Result<UrdfArm> parse_urdf(const std::string& urdf, const std::filesystem::path& folder = {},
                                         const UrdfConfig& config = {});
/// Reads a serial arm from a file. A name that ends in .xacro, and elements <xacro:…>, call for the program xacro in
/// PATH. Answers unavailable without it, and corrupt_data where it fails, each with the command to run; cancelled.
[[nodiscard]] Result<UrdfArm> read_urdf(const std::filesystem::path& path, const UrdfConfig& config = {});

struct BuiltinRobot {
  std::string_view name;
  std::string_view urdf;
};
/// Returns the files of robots/, in alphabetical order.
[[nodiscard]] const std::vector<BuiltinRobot>& builtin_robots();

/// Finds a built-in robot by the beginning of its name ("comau"), or reads a file. Answers not_found with the known
/// names.
[[nodiscard]] Result<UrdfArm> find_robot(const std::string& name_or_path, const UrdfConfig& config = {});

}  // namespace saccade
