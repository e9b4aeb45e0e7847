// SPDX-License-Identifier: Apache-2.0
#pragma once
// MotionPlanner: collision-free motions of an arm to the best of several configurations. parametrise: timing of a path
// within the limits of speed and acceleration.

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
  std::string planner{"RRTConnect"};  ///< one of planner_names(), named as in OMPL
  /// Limit of checked straight motions, first those to the goals, then a search's. This effort is equal on every
  /// machine; after it there is no path. Planners test it once per round, so slightly more may be checked.
  int max_motions{5000};
  double budget_s{2.0};    ///< limit of a search's wall time; if it ends a search, the result depends on the machine
  int shortcut_tries{60};  ///< consecutive failed attempts to shorten a found path by chords
  std::uint64_t seed{1};

  [[nodiscard]] Status validate() const;
};

/// Returns OMPL's planners that stop with the first path and depend on the seed alone.
[[nodiscard]] std::vector<std::string> planner_names();

struct MotionPlan {
  std::size_t goal{0};  ///< index of the configuration reached
  JointPath path;       ///< straight lines between configurations, free of collision
  Trajectory trajectory;
};

/// Result of planning.
struct PlanOutcome {
  std::optional<MotionPlan> plan;
  std::optional<Refusal>
      refusal;      ///< set where there is no plan: start_in_collision, outside_limits, goal_in_collision, no_path
  std::string why;  ///< one sentence, for people
  int motions{0};   ///< checked motions: those to the goals and the search's
  double search_ms{0.0};
  double shortcut_ms{0.0};  ///< includes timing the path
};

/// Planner of motions. It takes the straight motion to the nearest goal that has one (nearest in seconds), otherwise a
/// path by sampling (OMPL), from which corners are cut as long as that saves time. Every motion is free by
/// ArmCollision: at configurations between which no point of the arm moves farther than max_step_m, or than the free
/// space around it. Between them it could graze a corner by at most half a step minus the balls' excess over the links.
/// A seed gives one plan, independent of earlier and concurrent planning. Immutable; safe for concurrent use. While it
/// plans, OMPL's messages are silenced, and the seed of its generators is set.
class MotionPlanner {
 public:
  /// Answers invalid_argument for a bad configuration, with the known names for an unknown planner.
  [[nodiscard]] static Result<MotionPlanner> create(const ArmCollision& collision,
                                                    const MotionPlannerConfig& config = {});

  /// Plans a motion to one of the goals, which are configurations. The start may be up to 1e-6 beyond a limit. Answers
  /// invalid_argument where a configuration has the wrong number of joints, or there is no goal; all other failures are
  /// refusals. Microseconds where the straight motion is free.
  [[nodiscard]] Result<PlanOutcome> plan(const Configuration& start, std::span<const Configuration> goals,
                                         const ObstacleMap& obstacles) const;

  /// Plans the straight motion only; no_path where it is not free.
  [[nodiscard]] Result<PlanOutcome> plan_straight(const Configuration& start, std::span<const Configuration> goals,
                                                  const ObstacleMap& obstacles) const;

  /// Tells whether the whole trajectory is free, checked in steps in which no point of the arm moves farther than
  /// max_step_m.
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

/// Tells whether the arm is free along a whole piece of a trajectory.
using PieceIsFree = std::function<bool(const Trajectory::Piece& piece)>;

/// Times a path. On every straight line all joints start, cruise and brake together, the slowest at its limit. At an
/// inner configuration the arm follows a parabola that cuts the corner without stopping, if `is_free` accepts it;
/// otherwise, and without is_free, it stops there. A parabola takes at most half of each adjacent line, and is never
/// slower than stopping. Configurations within 1e-12 of the previous one are skipped. The last configuration is reached
/// up to rounding.
/// O(configurations) and about as many calls of is_free, or a few times more.
[[nodiscard]] Trajectory parametrise(const ArmModel& arm, const JointPath& path, const PieceIsFree& is_free = {});

/// Returns the seconds of parametrise without is_free: every line from rest to rest. O(configurations)
[[nodiscard]] double rest_to_rest_s(const ArmModel& arm, const Configuration& from, const Configuration& to);
[[nodiscard]] double rest_to_rest_s(const ArmModel& arm, const JointPath& path);

}  // namespace saccade
