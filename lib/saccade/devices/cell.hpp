// SPDX-License-Identifier: Apache-2.0
#pragma once
// Cell: the devices of a real cell, as its YAML file names them beside the workspace and the scan. docs/cell.md.

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

/// Keys of a cell's file that describe devices; the others are those of a scene.
inline constexpr std::array<std::string_view, 8> kCellKeys{"camera", "arm",  "joints",   "robot",
                                                           "hand",   "free", "fixtures", "tracking"};

/// A program that a cell names.
struct CellProgram {
  std::string command;                ///< empty: there is none
  std::optional<double> timeout_s{};  ///< until it has answered
};

/// An arm, and where it holds the camera.
struct CellArm {
  std::string robot;  ///< a built-in arm, or a URDF file, relative to the cell's
  std::string base;
  std::string tip;
  std::string camera_frame;
  std::optional<Pose> T_world_base{};
  std::optional<Pose> T_flange_camera{};  ///< measured by saccade calibrate
  std::map<std::string, std::filesystem::path> packages;
  bool drop_beyond_tip{false};
  double speed{1.0};  ///< share of the speeds that the URDF allows
};

/// How joints behind a program are watched; nullopt: ProgramJointsConfig's own.
struct CellWatch {
  std::optional<double> tolerance{};
  std::optional<double> lag_s{};
  std::optional<double> watchdog_s{};
};

struct Cell {
  std::filesystem::path folder;  ///< of the file: programs run there
  std::optional<CellArm> arm{};
  CellProgram camera{};
  CellProgram joints{};
  CellProgram robot{};
  CellProgram hand{};
  CellWatch watch{};
  double camera_clock_offset_s{0.0};  ///< to be added to the camera's times for those of the joints
  std::string tracking{};             ///< forced, hint or icp; empty: not said
  std::vector<Box> fixtures{};
  std::vector<Box> free{};
};

/// Reads the devices; keys of a scene are passed over. corrupt_data, with line and column, for what is no YAML, an
/// unknown or missing key, or a value of the wrong kind; invalid_argument for programs that exclude each other.
[[nodiscard]] Result<Cell> parse_cell(std::string_view yaml, const std::filesystem::path& folder = {});
/// Reads them from a file; its errors name it.
[[nodiscard]] Result<Cell> read_cell(const std::filesystem::path& path);

}  // namespace saccade
