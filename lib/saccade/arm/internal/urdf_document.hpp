// SPDX-License-Identifier: Apache-2.0
#pragma once
// URDF as urdfdom reads it, without its printing, and with additional checks.

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <map>
#include <string>

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

struct UrdfDocument {
  urdf::ModelInterfaceSharedPtr model;          ///< a tree: every link but the root has one parent
  std::map<std::string, double> accelerations;  ///< by joint, where <limit> has the attribute
};

/// Answers corrupt_data with the reason in one line.
[[nodiscard]] Result<UrdfDocument> parse_urdf_document(const std::string& text);

/// Answers invalid_argument for values that are not finite, with `where`.
[[nodiscard]] Result<Pose> pose_of(const urdf::Pose& pose, const std::string& where);

}  // namespace saccade
