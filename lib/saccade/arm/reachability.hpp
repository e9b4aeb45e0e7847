// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reachability: which camera poses an arm can take without touching anything, before any path is looked for.

#include <optional>
#include <span>
#include <vector>

#include "saccade/arm/arm_collision.hpp"
#include "saccade/arm/inverse_kinematics.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/robot/refusal.hpp"

namespace saccade {

/// What stands at a pose: the configurations that have the camera there and touch nothing, or why there is none.
struct PoseGoals {
  std::vector<Configuration> free;
  std::optional<Refusal> refusal;  ///< no_ik, outside_limits or goal_in_collision
};

/// Immutable, cheap to copy, safe for concurrent use.
class Reachability {
 public:
  /// Errors: those of InverseKinematics::create.
  [[nodiscard]] static Result<Reachability> create(const ArmCollision& collision, const IkConfig& config = {});

  /// All of InverseKinematics::solve that are free. A pose that has no solution within the limits is asked about once
  /// more without them, to tell outside_limits from no_ik.
  [[nodiscard]] PoseGoals goals(const Pose& T_world_camera, const Configuration& reference,
                                const ObstacleMap& obstacles) const;

  /// For each pose the refusal of goals(), nullopt where it has a free configuration; looks at no more of them than it
  /// takes. Some 2 to 10 µs at the median in closed form (bench/reachability.cpp). The thread count never changes the
  /// result.
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
  InverseKinematics boundless_;  ///< the same arm without limits of its turning joints
};

}  // namespace saccade
