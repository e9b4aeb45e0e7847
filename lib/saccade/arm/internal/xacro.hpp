// SPDX-License-Identifier: Apache-2.0
#pragma once
// needs_xacro, run_xacro: robot descriptions with macros, which the user's program xacro expands.

#include <filesystem>
#include <string>

#include "saccade/arm/urdf.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// Tells whether a text has elements <xacro:…>, comments left out.
[[nodiscard]] bool has_xacro_elements(const std::string& text);

/// Returns the command that expands a file, for messages; "FILE" stands for a path that is not known.
[[nodiscard]] std::string xacro_command(const std::filesystem::path& path);

/// Runs "xacro PATH", with the program found in PATH, and returns its output. The program's ROS_PACKAGE_PATH begins
/// with UrdfConfig::package_paths. It has no input, and its process group is killed when the time is over or
/// UrdfConfig::cancelled answers true.
/// @return unavailable without such a program; corrupt_data with its last words when it fails; io_failure when it takes
/// too long; cancelled. Each with the command to run by hand.
[[nodiscard]] Result<std::string> run_xacro(const std::filesystem::path& path, const UrdfConfig& config);

}  // namespace saccade
