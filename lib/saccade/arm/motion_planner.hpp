// SPDX-License-Identifier: Apache-2.0
#pragma once
// MotionPlanner: collision-free motions of an arm to the best of several configurations; parametrise: a path with its
// times, within the limits of speed and acceleration.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "saccade/arm/arm_collision.hpp"
#include "saccade/arm/arm_model.hpp"
#include "saccade/robot/refusal.hpp"
#include "saccade/robot/trajectory.hpp"

namespace saccade {

struct MotionPlannerConfig {
  std::string planner{"RRTConnect"};  ///< one of planner_names(), as OMPL calls it
  /// Straight motions that are checked at most, first those to the goals, then a search's: the effort after which there
  /// is no path, the same on every machine. Planners look at it once a round, so a few more may be checked.
  int max_motions{5000};
  double budget_s{2.0};  ///< wall time of a search at most; where it runs out first, the result depends on the machine
  int shortcut_tries{60};  ///< chords across a found path that are tried in a row without gain
  std::uint64_t seed{1};

  [[nodiscard]] Status validate() const;
};

/// Planners of OMPL that stop with the first path and depend on the seed alone.
[[nodiscard]] std::vector<std::string> planner_names();

struct MotionPlan {
  std::size_t goal{0};  ///< index of the configuration that is gone to
  JointPath path;       ///< straight lines between configurations, free all along
  Trajectory trajectory;
};

/// What planning came to.
struct PlanOutcome {
  std::optional<MotionPlan> plan;
  std::optional<Refusal>
      refusal;      ///< where there is no plan: start_in_collision, outside_limits, goal_in_collision, no_path
  std::string why;  ///< one sentence, for people
  int motions{0};   ///< checked: those to the goals and the search's
  double search_ms{0.0};
  double shortcut_ms{0.0};  ///< with the times along the path
};

/// The straight motion to the nearest goal that has one (nearest in seconds), else a path by sampling (OMPL), from
/// which corners are cut as long as that saves time. Every motion is free by ArmCollision: at configurations between
/// which no point of the arm moves farther than max_step_m, or than what is free around it; in between it could graze a
/// corner by half a step less what the balls exceed the links. One seed gives one plan, whatever was planned before and
/// whoever else plans. Immutable; safe for concurrent use. OMPL's messages are silenced while it plans, and the seed of
/// its generators is set.
class MotionPlanner {
 public:
  /// invalid_argument for a bad configuration, with the known names for an unknown planner.
  [[nodiscard]] static Result<MotionPlanner> create(const ArmCollision& collision,
                                                    const MotionPlannerConfig& config = {});

  /// Goals are configurations, one of which is wanted; the start may be 1e-6 beyond a limit. invalid_argument where one
  /// has not the arm's number of joints, or there is none; everything else that can go wrong is a refusal. Microseconds
  /// where the straight motion is free.
  [[nodiscard]] Result<PlanOutcome> plan(const Configuration& start, std::span<const Configuration> goals,
                                         const ObstacleMap& obstacles) const;

  /// The straight motion alone; no_path where it is not free.
  [[nodiscard]] Result<PlanOutcome> plan_straight(const Configuration& start, std::span<const Configuration> goals,
                                                  const ObstacleMap& obstacles) const;

  /// Whether the arm is free all along, by steps in which no point of it moves farther than max_step_m.
  [[nodiscard]] bool is_free(const Trajectory& trajectory, const ObstacleMap& obstacles) const;

  [[nodiscard]] const ArmCollision& collision() const { return collision_; }
  [[nodiscard]] const MotionPlannerConfig& config() const { return config_; }

 private:
  MotionPlanner(ArmCollision collision, MotionPlannerConfig config)
      : collision_{std::move(collision)}, config_{std::move(config)} {}
  [[nodiscard]] std::optional<PlanOutcome> refuse(const Configuration& start, std::span<const Configuration> goals,
                                                  std::vector<std::size_t>& usable, const ObstacleMap& obstacles) const;
  [[nodiscard]] bool piece_is_free(const Trajectory::Piece& piece, const ObstacleMap& obstacles) const;

  ArmCollision collision_;
  MotionPlannerConfig config_;
};

/// Whether the arm is free all along a piece of a trajectory.
using PieceIsFree = std::function<bool(const Trajectory::Piece& piece)>;

/// On every straight line all joints start, cruise and brake together, the slowest at its limit. At an inner
/// configuration, where `is_free` says that a parabola which cuts the corner is free, the arm turns without stopping;
/// elsewhere, and with no `is_free`, it stops there. A parabola takes no more than half of the lines beside it, both
/// together are never slower than stopping. Configurations within 1e-12 of the one before are passed over. The last
/// configuration is met to rounding.
/// O(configurations) and as many calls of is_free, or a few times as many.
[[nodiscard]] Trajectory parametrise(const ArmModel& arm, const JointPath& path, const PieceIsFree& is_free = {});

/// Seconds of parametrise without is_free: every line from rest to rest. O(configurations)
[[nodiscard]] double rest_to_rest_s(const ArmModel& arm, const Configuration& from, const Configuration& to);
[[nodiscard]] double rest_to_rest_s(const ArmModel& arm, const JointPath& path);

}  // namespace saccade
