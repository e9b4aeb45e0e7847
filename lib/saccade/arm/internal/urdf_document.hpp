// SPDX-License-Identifier: Apache-2.0
#pragma once
// A URDF as urdfdom reads it, without its printing, and with the checks that it leaves out.

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <filesystem>
#include <map>
#include <string>

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

struct UrdfDocument {
  urdf::ModelInterfaceSharedPtr model;          ///< a tree: every link but the root has one parent
  std::map<std::string, double> accelerations;  ///< by joint, where <limit> has the attribute
};

/// corrupt_data with the reason in one line.
[[nodiscard]] Result<UrdfDocument> parse_urdf_document(const std::string& text);

/// invalid_argument for what is not finite, with `where`.
[[nodiscard]] Result<Pose> pose_of(const urdf::Pose& pose, const std::string& where);

/// The file that a mesh's name stands for: package://NAME/…, file://…, or a path relative to `folder`. Packages not
/// among `packages` are looked for in `folder` and above it: a folder of that name, or one whose package.xml says so.
[[nodiscard]] Result<std::filesystem::path> resolve_mesh(const std::string& uri, const std::filesystem::path& folder,
                                                         const std::map<std::string, std::filesystem::path>& packages);

}  // namespace saccade
