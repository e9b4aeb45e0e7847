// SPDX-License-Identifier: Apache-2.0
#pragma once
// PlannedArm: an arm that plans its own motions through the map.

#include <memory>

#include "saccade/arm/motion_planner.hpp"
#include "saccade/arm/reachability.hpp"
#include "saccade/core/hidden.hpp"
#include "saccade/robot/joint_controller.hpp"
#include "saccade/robot/robot.hpp"

namespace saccade {

class ExecutedPath;

struct PlannedArmConfig {
  IkConfig ik;
  ArmCollisionConfig collision;
  MotionPlannerConfig planner;
  ObstacleConfig obstacles;  ///< including the fixtures around the arm
  /// Initial configuration, which is also the stand-by pose. Empty: the one nearest to the arm's middle that reaches
  /// the first possible pose of `first_poses` without touching a fixture; the middle if there is none.
  std::optional<Configuration> start;
  std::vector<Pose> first_poses;  ///< camera poses, such as those of the initial scan

  [[nodiscard]] Status validate() const;
};

/// Arm that plans motions and lets a JointController execute them. The map that it follows has a workspace; space
/// outside it is free except for the fixtures.
class PlannedArm final : public Robot {
 public:
  /// @param joints  moves the arm, which starts at its current position if config names no start; nullptr:
  /// SimulatedJoints.
  /// @return invalid_argument: a bad configuration, a map without a workspace, a start outside the limits, with a wrong
  /// number of joints, or in collision with a fixture or itself; errors of ArmCollision, InverseKinematics, ObstacleMap
  /// and joints.
  [[nodiscard]] static Result<PlannedArm> create(const ArmModel& arm, const TsdfConfig& map,
                                                 PlannedArmConfig config = {},
                                                 std::shared_ptr<JointController> joints = nullptr);

  [[nodiscard]] std::optional<Configuration> configuration() const override { return q_; }
  /// Calls ObstacleMap::update. Where the arm's current configuration then touches something, the next plan begins with
  /// ExecutedPath::retreat_from, if there is a retreat.
  [[nodiscard]] Status follow(const TsdfSnapshot& map, const Executor& executor) override;
  /// Returns the unknown cells of the planner's map within 5 mm of the arm's motion.
  [[nodiscard]] Result<std::vector<Box>> swept_volume(std::span<const Pose> T_world_camera) override;
  [[nodiscard]] std::vector<std::optional<Refusal>> test(std::span<const Pose> T_world_camera,
                                                         const Executor& executor) const override;
  /// Renders the arm as it stands in the nearest free configuration. Errors: those of ArmSilhouette::create.
  [[nodiscard]] Result<OwnBody> own_body(const PinholeCamera& sensor) const override;
  /// Plans to the nearest configuration of any of the poses: MotionPlanner.
  [[nodiscard]] Result<PlannedMotion> plan(std::span<const Pose> T_world_camera,
                                           MotionKind way = MotionKind::planned) override;

  [[nodiscard]] std::vector<MotionSample> camera_on_way(const Motion& motion, double every_s) const override;
  /// Checks straight lines between positions kLookAhead_s apart.
  [[nodiscard]] bool still_free(const Motion& motion, double t_s) const override;
  [[nodiscard]] Result<PlannedMotion> plan_to_stand_by() override;
  /// Calls on_way at the samples of the joints, and at the end. Answers invalid_argument for a motion that does not
  /// begin at the arm's position; errors of the joints.
  [[nodiscard]] Result<std::optional<Arrival>> execute(const Motion& motion,
                                                       const MotionObserver& on_way = {}) override;
  /// Returns all motions so far.
  [[nodiscard]] const std::vector<Trajectory>& motions() const { return motions_; }

  /// Sets the configuration of an arm moved by other means, such as in an earlier run. Answers invalid_argument outside
  /// its limits.
  [[nodiscard]] Status place(const Configuration& q);

  [[nodiscard]] const ArmModel& arm() const { return reachability_.arm(); }
  [[nodiscard]] const Reachability& reachability() const { return reachability_; }
  [[nodiscard]] const ObstacleMap& obstacles() const { return obstacles_; }
  [[nodiscard]] Pose T_world_camera() const { return camera_pose(arm(), q_); }

 private:
  /// Planning components for a map in which nothing has been seen.
  struct Parts {
    Reachability reachability;
    MotionPlanner planner;
    ObstacleMap fixtures;
    ObstacleMap obstacles;
    Configuration start;
  };
  static constexpr double kLookAhead_s{0.05};
  PlannedArm(Parts parts, std::shared_ptr<JointController> joints);
  [[nodiscard]] static Result<Parts> make_parts(const ArmModel& arm, const TsdfConfig& map,
                                                const PlannedArmConfig& config);
  /// Checks that a motion begins at the arm's position.
  [[nodiscard]] Status check_start(const Motion& motion) const;
  [[nodiscard]] Configuration planned_from() const { return retreat_ ? retreat_->end() : q_; }
  /// Prepends the retreat, if there is one.
  void begin_with_retreat(Motion& motion) const;
  [[nodiscard]] Result<PlannedMotion> plan_among(std::span<const Pose> T_world_camera, MotionKind way,
                                                 const Configuration& from, const ObstacleMap& obstacles) const;

  Reachability reachability_;
  MotionPlanner planner_;
  std::shared_ptr<JointController> joints_;
  ObstacleMap fixtures_;  ///< fixtures only, without the map
  ObstacleMap obstacles_;
  Configuration stand_by_;
  Configuration q_;
  Hidden<ExecutedPath> way_;
  std::optional<Trajectory> retreat_;  ///< out of the current contact
  std::vector<Trajectory> motions_;
};

}  // namespace saccade
