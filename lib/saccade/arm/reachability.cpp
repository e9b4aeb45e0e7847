// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/reachability.hpp"

#include <algorithm>

namespace saccade {
namespace {

Result<ArmModel> without_limits(const ArmModel& arm) {
  ArmDescription description = arm.description();
  for (ArmJoint& joint : description.joints) {
    if (joint.kind == JointKind::revolute) joint.kind = JointKind::continuous;
  }
  for (ArmLink& link : description.links) link.bodies.clear();
  return ArmModel::create(std::move(description));
}

}  // namespace

Result<Reachability> Reachability::create(const ArmCollision& collision, const IkConfig& config) {
  SACCADE_TRY(InverseKinematics ik, InverseKinematics::create(collision.arm(), config));
  SACCADE_TRY(ArmModel boundless_arm, without_limits(collision.arm()));
  SACCADE_TRY(InverseKinematics boundless, InverseKinematics::create(std::move(boundless_arm), config));
  return Reachability{collision, std::move(ik), std::move(boundless)};
}

Refusal Reachability::why_none(const Pose& T_world_camera) const {
  return boundless_.solve(T_world_camera).empty() ? Refusal::no_ik : Refusal::outside_limits;
}

PoseGoals Reachability::goals(const Pose& T_world_camera, const Configuration& reference,
                              const ObstacleMap& obstacles) const {
  std::vector<Configuration> solutions = ik_.solve(T_world_camera, reference);
  if (solutions.empty()) return {{}, why_none(T_world_camera)};
  std::erase_if(solutions, [&](const Configuration& q) { return collision_.contact(q, obstacles).has_value(); });
  if (solutions.empty()) return {{}, Refusal::goal_in_collision};
  return {std::move(solutions), std::nullopt};
}

std::vector<std::optional<Refusal>> Reachability::test(std::span<const Pose> T_world_camera,
                                                       const Configuration& reference, const ObstacleMap& obstacles,
                                                       const Executor& executor) const {
  constexpr std::size_t kGrain{64};
  std::vector<std::optional<Refusal>> refusals(T_world_camera.size());
  executor.parallel_for(T_world_camera.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::vector<Configuration> solutions = ik_.solve(T_world_camera[i], reference);
      const bool any_free = std::any_of(solutions.begin(), solutions.end(), [&](const Configuration& q) {
        return !collision_.contact(q, obstacles).has_value();
      });
      if (any_free) continue;
      refusals[i] = solutions.empty() ? why_none(T_world_camera[i]) : Refusal::goal_in_collision;
    }
  });
  return refusals;
}

}  // namespace saccade
