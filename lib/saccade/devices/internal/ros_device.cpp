// SPDX-License-Identifier: Apache-2.0
#include "saccade/devices/internal/ros_device.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <sstream>

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 8> kCameraOptions{"info",      "color",     "frame",     "reference",
                                                         "min-range", "max-range", "rectified", "skip"};
constexpr std::array<std::string_view, 1> kJointsOptions{"states"};
constexpr std::array<std::string_view, 1> kHandOptions{"reference"};

/// Returns the ROS version by the prefix of a name.
const RosProgram* version_of(std::string_view command) {
  const auto found = std::find_if(kRosPrograms.begin(), kRosPrograms.end(),
                                  [&](const RosProgram& program) { return command.starts_with(program.prefix); });
  return found == kRosPrograms.end() ? nullptr : &*found;
}

bool can_run(const fs::path& path) { return fs::is_regular_file(path) && ::access(path.c_str(), X_OK) == 0; }

/// Returns the name from a prefix, a name and options.
std::string_view name_in(const RosProgram& version, std::string_view command) {
  command.remove_prefix(version.prefix.size());
  return command.substr(0, command.find_first_of(" \t"));
}

}  // namespace

std::span<const std::string_view> ros_options(std::string_view role) {
  if (role == "camera") return kCameraOptions;
  if (role == "joints") return kJointsOptions;
  return kHandOptions;
}

bool is_over_ros(std::string_view command) { return version_of(command) != nullptr; }

Status check_over_ros(std::string_view role, std::string_view command) {
  const RosProgram* version = version_of(command);
  if (version == nullptr) return {};
  if (role != "camera" && role != "joints" && role != "hand") {
    return Error{Errc::invalid_argument,
                 "a " + std::string{role} +
                     " that plans for itself has no program over ROS; give the arm with its "
                     "URDF, and joints: " +
                     std::string{version->prefix} + "/…/follow_joint_trajectory",
                 std::string{command}};
  }
  const std::string_view name = name_in(*version, command);
  const auto may_be = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '/'; };
  if (!name.empty() && std::all_of(name.begin(), name.end(), may_be)) return {};
  return Error{Errc::invalid_argument,
               std::string{version->prefix} + " needs a name of ROS after it, such as " + std::string{version->prefix} +
                   "/camera/depth: letters, digits, _ and /",
               std::string{command}};
}

std::string shell_quoted(std::string_view text) {
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '/' || c == '-' || c == '.';
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return std::string{text};
  std::string quoted{"'"};
  for (const char c : text) quoted += c == '\'' ? std::string{"'\\''"} : std::string{c};
  return quoted + "'";
}

fs::path find_program(std::string_view name) {
  std::error_code ignored;
  const fs::path beside = fs::read_symlink("/proc/self/exe", ignored).parent_path() / name;
  if (can_run(beside)) return beside;
  const char* searched = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe): nothing here changes it
  std::istringstream folders{searched == nullptr ? "" : searched};
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (!folder.empty() && can_run(fs::path{folder} / name)) return fs::absolute(fs::path{folder} / name);
  }
  return {};
}

Result<std::string> quoted_program(const RosProgram& version, const std::string& context) {
  const fs::path program = find_program(version.program);
  if (!program.empty()) return shell_quoted(program.string());
  return Error{Errc::unavailable,
               "this saccade was built without " + std::string{version.name} + ": there is no " +
                   std::string{version.program} + " beside it or in PATH; install " + std::string{version.packages} +
                   ", and build it again",
               context};
}

Result<std::string> ros_command_line(std::string_view role, const std::string& command) {
  const RosProgram* version = version_of(command);
  if (version == nullptr) return command;
  SACCADE_CHECK(check_over_ros(role, command));
  SACCADE_TRY(const std::string program, quoted_program(*version, command));
  return program + " " + std::string{role} + " " + command.substr(version->prefix.size());
}

}  // namespace saccade
