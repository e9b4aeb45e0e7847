// SPDX-License-Identifier: Apache-2.0
#pragma once
// UrdfPackages: where the meshes of a URDF lie, and the folders of ROS packages.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "saccade/arm/urdf.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// Finder of the files that a URDF names: package://NAME/…, file://…, or a path relative to the URDF's folder.
/// Searches a package in this order: UrdfConfig::packages; the URDF's folder and those above it;
/// UrdfConfig::package_paths; ROS_PACKAGE_PATH; the folders `share` of AMENT_PREFIX_PATH. Remembers what it found. One
/// thread.
class UrdfPackages {
 public:
  UrdfPackages(const std::filesystem::path& folder, const UrdfConfig& config);

  /// Answers not_found with the folders that were searched and what to do; unsupported for other schemes.
  [[nodiscard]] Result<std::filesystem::path> file(const std::string& uri);

 private:
  using Folders = std::vector<std::filesystem::path>;

  [[nodiscard]] const Folders& around(const std::string& package);
  [[nodiscard]] const Folders& on_paths(const std::string& package);
  [[nodiscard]] Error missing(const std::string& package, const std::string& uri);

  std::filesystem::path folder_;
  const UrdfConfig& config_;
  Folders paths_;  ///< from the configuration and the environment
  std::map<std::string, Folders> around_;
  std::map<std::string, Folders> on_paths_;
};

/// Splits a list of folders at colons: "/opt/ros/share:/opt/robots". Empty parts are left out.
[[nodiscard]] std::vector<std::filesystem::path> split_paths(const std::string& list);

/// Returns the paths of the configuration, then those of ROS_PACKAGE_PATH and AMENT_PREFIX_PATH, each once.
[[nodiscard]] std::vector<std::filesystem::path> package_search_paths(const UrdfConfig& config);

}  // namespace saccade
