// SPDX-License-Identifier: Apache-2.0
#include "view_json.hpp"

#include "saccade/arm/arm_mesh.hpp"

namespace saccade::cli {

std::optional<RobotDrawing> drawing_of(const ArmModel* arm, const std::optional<Configuration>& q,
                                       const std::vector<Eigen::Vector3d>& path) {
  if (arm == nullptr || !q) return std::nullopt;
  const Eigen::Vector3d p_base = (arm->T_world_base() * arm->joint(0).T_parent_joint).translation();
  constexpr double kOpacity{0.4};  // the map is seen through the arm
  return RobotDrawing{arm_mesh(*arm, *q), path, p_base, kOpacity};
}

}  // namespace saccade::cli
