// SPDX-License-Identifier: Apache-2.0
#pragma once
// Arms from URDF files, and the robots that come with Saccade. What is read and what is made of it: docs/robots.md.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/arm/arm_model.hpp"

namespace saccade {

/// The camera's optical frame, where a URDF has a link of this name.
constexpr std::string_view kCameraFrame{"camera_optical_frame"};

struct UrdfConfig {
  std::string base;  ///< link that the chain begins with; empty: the root
  std::string tip;   ///< flange; empty: the link behind the camera's last joint, else the end of the longest chain
  std::string
      camera;  ///< optical frame, fixed to the flange; empty: kCameraFrame, else one that ends so, else the flange
  /// Folders of packages by name, for package://NAME/…; other names are looked for at the URDF and the folders above.
  std::map<std::string, std::filesystem::path> packages;
  double default_speed{1.0};           ///< of continuous joints without one, rad/s
  double acceleration_time_s{0.5};     ///< joints without an acceleration reach their speed in this time
  bool keep_beyond_tip{true};          ///< bodies fixed behind the flange belong to the arm
  std::optional<Pose> T_world_base{};  ///< where the chain's first link stands; nullopt: as the file says
  /// Where the camera's optical frame is on the flange, as it was measured; nullopt: as the file says.
  std::optional<Pose> T_flange_camera{};
};

struct UrdfArm {
  ArmModel arm;
  std::vector<std::string> notes;      ///< what was assumed or left out, a sentence each
  std::vector<std::string> choices{};  ///< the first of these: tip or camera, where neither file nor config names it
};

/// Reads a serial arm. Fixed joints are folded into the links; bodies of branches belong to the link that they hang on,
/// where joints that are not on the chain stand still: at 0, or at the limit next to it, or where the joint that they
/// follow puts them. What is chosen where the configuration leaves it open: docs/robots.md. Meshes are relative to
/// `folder`. The attribute `acceleration` (or `drake:acceleration`) of <limit> is read, as URDF itself has none.
/// corrupt_data for what is no URDF or no tree, and for limits or axes that make no sense; not_found for meshes and
/// packages; invalid_argument for links that are not there, for several tips or cameras that are as likely, and for a
/// T_world_base that is not rigid; unsupported for mimic, planar and floating joints on the chain. One line that names
/// the joint or link.
[[nodiscard]] Result<UrdfArm> parse_urdf(const std::string& urdf, const std::filesystem::path& folder = {},
                                         const UrdfConfig& config = {});
/// The same from a file.
[[nodiscard]] Result<UrdfArm> read_urdf(const std::filesystem::path& path, const UrdfConfig& config = {});

struct BuiltinRobot {
  std::string_view name;
  std::string_view urdf;
};
/// The files of robots/, in alphabetical order.
[[nodiscard]] const std::vector<BuiltinRobot>& builtin_robots();

/// A built-in robot by the beginning of its name ("comau"), or a file. not_found with the known names.
[[nodiscard]] Result<UrdfArm> find_robot(const std::string& name_or_path, const UrdfConfig& config = {});

}  // namespace saccade
