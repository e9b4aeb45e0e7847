// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reachability: the camera poses that an arm can take without collision, tested before any path is planned.

#include <optional>
#include <span>
#include <vector>

#include "saccade/arm/arm_collision.hpp"
#include "saccade/arm/inverse_kinematics.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/robot/refusal.hpp"

namespace saccade {

/// Configurations without collision that have the camera at a pose, or the reason why there is none.
struct PoseGoals {
  std::vector<Configuration> free;
  std::optional<Refusal> refusal;  ///< no_ik, outside_limits or goal_in_collision
};

/// Reachability test. Immutable, cheap to copy, safe for concurrent use.
class Reachability {
 public:
  /// Errors: those of InverseKinematics::create.
  [[nodiscard]] static Result<Reachability> create(const ArmCollision& collision, const IkConfig& config = {});

  /// Returns all free solutions of InverseKinematics::solve. A pose without a solution within the limits is solved once
  /// more without them, to distinguish outside_limits from no_ik.
  [[nodiscard]] PoseGoals goals(const Pose& T_world_camera, const Configuration& reference,
                                const ObstacleMap& obstacles) const;

  /// Returns for each pose the refusal of goals(), nullopt where it has a free configuration; examines no more
  /// configurations than necessary. Some 2 to 10 µs at the median in closed form (bench/reachability.cpp). The thread
  /// count never changes the result.
  [[nodiscard]] std::vector<std::optional<Refusal>> test(std::span<const Pose> T_world_camera,
                                                         const Configuration& reference, const ObstacleMap& obstacles,
                                                         const Executor& executor) const;

  [[nodiscard]] const ArmModel& arm() const { return ik_.arm(); }
  [[nodiscard]] const ArmCollision& collision() const { return collision_; }
  [[nodiscard]] const InverseKinematics& ik() const { return ik_; }

 private:
  Reachability(ArmCollision collision, InverseKinematics ik, InverseKinematics boundless)
      : collision_{std::move(collision)}, ik_{std::move(ik)}, boundless_{std::move(boundless)} {}
  [[nodiscard]] Refusal why_none(const Pose& T_world_camera) const;

  ArmCollision collision_;
  InverseKinematics ik_;
  InverseKinematics boundless_;  ///< arm without limits of its turning joints
};

}  // namespace saccade
