// SPDX-License-Identifier: Apache-2.0
#pragma once
// Joints that open and close a gripper, or follow others beside the arm, and so do not belong to the arm itself.

#include <set>
#include <string>

#include "saccade/arm/internal/urdf_tree.hpp"

namespace saccade {

/// Returns the names of the first joints of such branches below `base`. A URDF does not mark them, so they are
/// recognised by their structure, and only behind joints of an arm:
/// - joints that follow one which is not on their own path from the base (<mimic>), together with the joint that they
/// follow where both hang on one rigid body and nothing else moves behind them;
/// - fingers and jaws, recognised by name;
/// - two or more short sliding joints on one body;
/// - behind six joints or more: two branches of equal joints, or three and more, each with fewer joints than the arm;
/// - other independently moving joints on such a body.
/// O(joints · depth).
[[nodiscard]] std::set<std::string> gripper_joints(const UrdfTree& tree, const std::string& base);

}  // namespace saccade
