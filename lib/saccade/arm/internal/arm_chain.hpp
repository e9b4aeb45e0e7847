// SPDX-License-Identifier: Apache-2.0
#pragma once
// ArmChain: the joints of a URDF that form the arm, its end, and the link that is the camera's optical frame.

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
  std::vector<urdf::JointSharedPtr> joints;  ///< from base to tip, including fixed ones
  std::set<std::string> gripper;             ///< gripper_joints()
  std::vector<std::string> choices;          ///< choices that neither the file nor the configuration makes, one
                                             ///< sentence each
};

/// Chooses what the configuration leaves open, as docs/guides/robots.md says under "What is chosen". Answers
/// invalid_argument for links that do not exist or do not follow each other, and where several tips or cameras are
/// equally likely, listing them; corrupt_data where no joint moves.
[[nodiscard]] Result<ArmChain> find_arm_chain(const UrdfTree& tree, const UrdfConfig& config);

}  // namespace saccade
