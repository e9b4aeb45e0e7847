// SPDX-License-Identifier: Apache-2.0
#pragma once
// Cell: the devices of a real cell, named in its YAML file beside the workspace and the scan. docs/reference/cell.md.

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/core/region.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// Keys of a cell's file that describe devices; all others belong to a scene.
inline constexpr std::array<std::string_view, 8> kCellKeys{"camera", "arm",  "joints",   "robot",
                                                           "hand",   "free", "fixtures", "tracking"};

/// Program that a cell names.
struct CellProgram {
  std::string command;                ///< empty: none
  std::optional<double> timeout_s{};  ///< time limit of an answer
};

/// Arm, and the mount of its camera.
struct CellArm {
  std::string robot;  ///< built-in arm, or URDF file relative to the cell's
  std::string base;
  std::string tip;
  std::string camera_frame;
  std::optional<Pose> T_world_base{};
  std::optional<Pose> T_flange_camera{};  ///< measured by saccade calibrate
  std::map<std::string, std::filesystem::path> packages;
  std::vector<std::filesystem::path> package_paths{};
  bool drop_beyond_tip{false};
  double speed{1.0};  ///< share of the speeds that the URDF allows
};

/// Supervision of joints behind a program; nullopt: ProgramJointsConfig's default.
struct CellWatch {
  std::optional<double> tolerance{};
  std::optional<double> lag_s{};
  std::optional<double> watchdog_s{};
};

struct Cell {
  std::filesystem::path folder;  ///< folder of the file, in which programs run
  std::optional<CellArm> arm{};
  CellProgram camera{};
  CellProgram joints{};
  CellProgram robot{};
  CellProgram hand{};
  CellWatch watch{};
  double camera_clock_offset_s{0.0};  ///< added to the camera's times to get the joints' times
  std::string tracking{};             ///< forced, hint, icp or rgbd; empty: not given
  std::vector<Box> fixtures{};
  std::vector<Box> free{};
};

/// Reads the devices; keys of a scene are ignored. Answers corrupt_data, with line and column, for invalid YAML, an
/// unknown or missing key, or a value of the wrong kind; invalid_argument for programs that exclude each other.
[[nodiscard]] Result<Cell> parse_cell(std::string_view yaml, const std::filesystem::path& folder = {});
/// Reads the devices from a file; errors name it.
[[nodiscard]] Result<Cell> read_cell(const std::filesystem::path& path);

}  // namespace saccade
