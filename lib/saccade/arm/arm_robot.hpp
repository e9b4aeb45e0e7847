// SPDX-License-Identifier: Apache-2.0
#pragma once
// ArmRobot: an arm that finds its own way through the map; SimulatedRobot: one that moves in simulated time.

#include "saccade/arm/motion_planner.hpp"
#include "saccade/arm/reachability.hpp"
#include "saccade/core/hidden.hpp"
#include "saccade/robot/joint_controller.hpp"
#include "saccade/robot/robot.hpp"

namespace saccade {

class DrivenWay;

struct ArmRobotConfig {
  IkConfig ik;
  ArmCollisionConfig collision;
  MotionPlannerConfig planner;
  ObstacleConfig obstacles;  ///< with the fixtures around the arm
  /// How the arm stands in the beginning, its stand-by. Empty: as at the first of `first_poses` that it can take
  /// without touching a fixture, nearest to its middle; if there is none, in its middle.
  std::optional<Configuration> start;
  std::vector<Pose> first_poses;  ///< camera poses, as of the initial scan

  [[nodiscard]] Status validate() const;
};

/// Everything of a Robot but moving. The map that it follows has a workspace; what lies outside is free but for the
/// fixtures.
class ArmRobot : public Robot {
 public:
  [[nodiscard]] std::optional<Configuration> configuration() const override { return q_; }
  /// ObstacleMap::update. Where the arm then touches something as it stands, the next plan begins with
  /// DrivenWay::back_from, if there is a way back.
  [[nodiscard]] Status follow(const TsdfSnapshot& map, const Executor& executor) override;
  /// The unknown cells of the planner's map that the arm comes within 5 mm of.
  [[nodiscard]] Result<std::vector<Box>> swept_by(std::span<const Pose> T_world_camera) override;
  [[nodiscard]] std::vector<std::optional<Refusal>> test(std::span<const Pose> T_world_camera,
                                                         const Executor& executor) const override;
  /// To whichever configuration of whichever pose is the nearest: MotionPlanner.
  [[nodiscard]] Result<PlannedMotion> plan(std::span<const Pose> T_world_camera, Way way = Way::any) override;

  [[nodiscard]] Result<PlannedMotion> plan_to_stand_by() override;

  /// The arm was put there by other means, such as in an earlier run. invalid_argument outside its limits.
  [[nodiscard]] Status place(const Configuration& q);

  [[nodiscard]] const ArmModel& arm() const { return reachability_.arm(); }
  [[nodiscard]] const Reachability& reachability() const { return reachability_; }
  [[nodiscard]] const ObstacleMap& obstacles() const { return obstacles_; }
  [[nodiscard]] Pose T_world_camera() const { return camera_pose(arm(), q_); }

 protected:
  /// The parts of an ArmRobot for a map of this configuration, in which nothing has been seen.
  struct Parts {
    Reachability reachability;
    MotionPlanner planner;
    ObstacleMap fixtures;
    ObstacleMap obstacles;
    Configuration start;
  };
  explicit ArmRobot(Parts parts);
  [[nodiscard]] static Result<Parts> make_parts(const ArmModel& arm, const TsdfConfig& map,
                                                const ArmRobotConfig& config);
  /// Whether a motion begins where the arm stands.
  [[nodiscard]] Status check_start(const Motion& motion) const;
  /// The arm is on its way.
  void pass(const Configuration& q) { q_ = q; }
  /// The motion was made, and the arm stands like this now.
  void arrive(const Motion& motion, const Configuration& q);
  /// The arm stands like this; how it came there is not known.
  void stand(const Configuration& q);

 private:
  [[nodiscard]] Configuration planned_from() const { return retreat_ ? retreat_->end() : q_; }
  /// With the retreat before it, if there is one.
  void begin_with_retreat(Motion& motion) const;
  [[nodiscard]] Result<PlannedMotion> plan_among(std::span<const Pose> T_world_camera, Way way,
                                                 const Configuration& from, const ObstacleMap& obstacles) const;

  Reachability reachability_;
  MotionPlanner planner_;
  ObstacleMap fixtures_;  ///< without the map
  ObstacleMap obstacles_;
  Configuration stand_by_;
  Configuration q_;
  Hidden<DrivenWay> way_;
  std::optional<Trajectory> retreat_;  ///< out of the contact in which the arm stands
};

/// Moves exactly as planned, in no time, and says how long the real arm would take.
class SimulatedRobot final : public ArmRobot {
 public:
  static constexpr double kSample_s{SimulatedJoints::kSample_s};

  /// invalid_argument: a bad configuration, a map without a workspace, a start outside the limits or of another number
  /// of joints, or one that touches a fixture or itself; errors of ArmCollision, InverseKinematics and ObstacleMap.
  [[nodiscard]] static Result<SimulatedRobot> create(const ArmModel& arm, const TsdfConfig& map,
                                                     const ArmRobotConfig& config = {});

  /// on_way is called every kSample_s of simulated time, and at the end. invalid_argument for a motion that does not
  /// begin where the arm stands.
  [[nodiscard]] Result<std::optional<Arrival>> execute(const Motion& motion, const OnWay& on_way = {}) override;
  /// All so far.
  [[nodiscard]] const std::vector<Trajectory>& motions() const { return motions_; }

 private:
  explicit SimulatedRobot(Parts parts) : ArmRobot{std::move(parts)}, joints_{configuration().value()} {}
  SimulatedJoints joints_;
  std::vector<Trajectory> motions_;
};

}  // namespace saccade
