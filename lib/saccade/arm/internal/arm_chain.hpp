// SPDX-License-Identifier: Apache-2.0
#pragma once
// ArmChain: which joints of a URDF are the arm's, where it ends and which link is the camera's optical frame.

#include <set>
#include <string>
#include <vector>

#include "saccade/arm/internal/urdf_tree.hpp"
#include "saccade/arm/urdf.hpp"

namespace saccade {

struct ArmChain {
  std::string base;
  std::string tip;
  std::string camera;
  std::vector<urdf::JointSharedPtr> joints;  ///< from base to tip, fixed ones too
  std::set<std::string> gripper;             ///< gripper_joints()
  std::vector<std::string> choices;          ///< what neither the file nor the configuration says, a sentence each
};

/// Finds out what the configuration leaves open, as docs/robots.md says under "What is chosen". invalid_argument for
/// links that are not there or not behind each other, and where several tips or cameras are as likely, with these;
/// corrupt_data where nothing moves.
[[nodiscard]] Result<ArmChain> find_arm_chain(const UrdfTree& tree, const UrdfConfig& config);

}  // namespace saccade
