// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/reachability.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

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

/// Tells whether the contact occurs in every configuration with the camera at this pose: it involves only the last
/// link.
bool is_of_pose(const ArmModel& arm, const Contact& contact) {
  return contact.link == arm.dof() && !contact.other_link;
}

/// Tells whether the arm has the same shape in both, its joints turned by whole turns.
bool is_same_shape(const ArmModel& arm, const Configuration& a, const Configuration& b) {
  constexpr double kSame{1e-9};
  for (int i = 0; i < arm.dof(); ++i) {
    const double apart = a[i] - b[i];
    const bool turns = arm.joint(i).kind != JointKind::prismatic;
    if (std::fabs(turns ? std::remainder(apart, 2.0 * std::numbers::pi) : apart) > kSame) return false;
  }
  return true;
}

}  // namespace

Result<Reachability> Reachability::create(const ArmCollision& collision, const IkConfig& config) {
  SACCADE_TRY(InverseKinematics ik, InverseKinematics::create(collision.arm(), config));
  SACCADE_TRY(ArmModel boundless_arm, without_limits(collision.arm()));
  SACCADE_TRY(InverseKinematics boundless, InverseKinematics::create(std::move(boundless_arm), config));
  return Reachability{collision, std::move(ik), std::move(boundless)};
}

Refusal Reachability::why_none(const Pose& T_world_camera) const {
  const bool any = boundless_.any_of(T_world_camera, boundless_.arm().middle(), [](const auto&) { return true; });
  return any ? Refusal::outside_limits : Refusal::no_ik;
}

PoseGoals Reachability::goals(const Pose& T_world_camera, const Configuration& reference,
                              const ObstacleMap& obstacles) const {
  std::vector<Configuration> solutions = ik_.solve(T_world_camera, reference);
  if (solutions.empty()) return {{}, why_none(T_world_camera)};
  std::optional<Configuration> last;  // solutions that differ by whole turns follow each other
  bool collides = false;
  std::erase_if(solutions, [&](const Configuration& q) {
    if (!last || !is_same_shape(arm(), *last, q)) collides = collision_.contact(q, obstacles).has_value();
    last = q;
    return collides;
  });
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
      bool any = false;
      bool free = false;
      const auto settles = [&](const Configuration& q) {
        any = true;
        const std::optional<Contact> contact = collision_.contact(q, obstacles);
        free = !contact;
        return free || is_of_pose(arm(), *contact);
      };
      static_cast<void>(ik_.any_shape_of(T_world_camera[i], reference, std::cref(settles)));
      if (free) continue;
      refusals[i] = any ? Refusal::goal_in_collision : why_none(T_world_camera[i]);
    }
  });
  return refusals;
}

}  // namespace saccade
