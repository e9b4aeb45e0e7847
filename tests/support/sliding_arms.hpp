// SPDX-License-Identifier: Apache-2.0
#pragma once
// Arms in the plane z = 0 whose joints turn, turn without end or slide, and worlds of nothing but fixtures.

#include <string>
#include <utility>
#include <vector>

#include "saccade/arm/arm_model.hpp"
#include "saccade/arm/obstacle_map.hpp"
#include "support/test_arms.hpp"

namespace saccade::test {

/// Bars of `length_m` one behind the other; those that turn do so about z, those that slide do so along x.
inline ArmModel plane_arm(const std::vector<JointKind>& kinds, double length_m = 0.5) {
  ArmDescription description;
  description.name = "bars";
  description.links.push_back({"base", {}});
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    ArmJoint joint;
    joint.name = "joint_" + number;
    joint.kind = kinds[i];
    if (i > 0) joint.T_parent_joint = Pose{Eigen::Translation3d{length_m, 0.0, 0.0}};
    joint.limits = {-3.0, 3.0, 1.0 + 0.25 * static_cast<double>(i), 4.0 - 0.25 * static_cast<double>(i)};
    if (kinds[i] == JointKind::prismatic) {
      joint.axis_joint = Eigen::Vector3d::UnitX();
      joint.limits = {0.0, 0.4, 0.3, 1.0};
    }
    description.joints.push_back(joint);
    const BoxBody bar{{length_m, 0.04, 0.04}};
    description.links.push_back(
        {"bar_" + number, {{"bar", Pose{Eigen::Translation3d{0.5 * length_m, 0.0, 0.0}}, bar}}});
  }
  return ArmModel::create(description).value();
}

inline ArmModel three_bars() { return plane_arm({JointKind::revolute, JointKind::revolute, JointKind::revolute}); }

inline Configuration joints(std::initializer_list<double> values) {
  Configuration q{static_cast<Eigen::Index>(values.size())};
  std::copy(values.begin(), values.end(), q.data());
  return q;
}

/// Free space and these boxes.
inline ObstacleMap only(std::vector<Box> fixtures) {
  TsdfConfig config;
  config.voxel_size_m = 0.02;
  config.workspace = Box{{-0.1, -0.1, 0.8}, {0.1, 0.1, 1.0}};
  TsdfMap map = TsdfMap::create(config).value();
  SACCADE_EXPECTS(map.free(*config.workspace).ok());
  ObstacleConfig obstacles;
  obstacles.fixtures = std::move(fixtures);
  return ObstacleMap::create(map.snapshot(), obstacles, {}).value();
}

}  // namespace saccade::test
