// SPDX-License-Identifier: Apache-2.0
#include "view_json.hpp"

#include "saccade/arm/arm_mesh.hpp"

namespace saccade::cli {

std::optional<RobotDrawing> drawing_of(const ArmModel* arm, const std::optional<Configuration>& q,
                                       const std::vector<Eigen::Vector3d>& path) {
  if (arm == nullptr || !q) return std::nullopt;
  constexpr double kTall_m{0.9};  // an arm rises about so far above its first joint
  const Eigen::Vector3d p_base = (arm->T_world_base() * arm->joint(0).T_parent_joint).translation();
  return RobotDrawing{arm_mesh(*arm, *q), path, p_base, {p_base + kTall_m * Eigen::Vector3d::UnitZ()}};
}

}  // namespace saccade::cli
