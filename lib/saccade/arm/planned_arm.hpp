// SPDX-License-Identifier: Apache-2.0
#pragma once
// PlannedArm: an arm that finds its own way through the map.

#include <memory>

#include "saccade/arm/motion_planner.hpp"
#include "saccade/arm/reachability.hpp"
#include "saccade/core/hidden.hpp"
#include "saccade/robot/joint_controller.hpp"
#include "saccade/robot/robot.hpp"

namespace saccade {

class DrivenWay;

struct PlannedArmConfig {
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

/// Plans, and lets a JointController move. The map that it follows has a workspace; what lies outside is free but for
/// the fixtures.
class PlannedArm final : public Robot {
 public:
  /// @param joints  moves the arm, which begins as it stands there, if config names no start; nullptr: SimulatedJoints.
  /// @return invalid_argument: a bad configuration, a map without a workspace, a start outside the limits or of another
  ///         number of joints, or one that touches a fixture or itself; errors of ArmCollision, InverseKinematics,
  ///         ObstacleMap and joints.
  [[nodiscard]] static Result<PlannedArm> create(const ArmModel& arm, const TsdfConfig& map,
                                                 PlannedArmConfig config = {},
                                                 std::shared_ptr<JointController> joints = nullptr);

  [[nodiscard]] std::optional<Configuration> configuration() const override { return q_; }
  /// ObstacleMap::update. Where the arm then touches something as it stands, the next plan begins with
  /// DrivenWay::back_from, if there is a way back.
  [[nodiscard]] Status follow(const TsdfSnapshot& map, const Executor& executor) override;
  /// The unknown cells of the planner's map that the arm comes within 5 mm of.
  [[nodiscard]] Result<std::vector<Box>> swept_by(std::span<const Pose> T_world_camera) override;
  [[nodiscard]] std::vector<std::optional<Refusal>> test(std::span<const Pose> T_world_camera,
                                                         const Executor& executor) const override;
  /// As the arm stands in the nearest configuration that is free. Errors: those of ArmSilhouette::create.
  [[nodiscard]] Result<OwnBody> own_body(const PinholeCamera& sensor) const override;
  /// To whichever configuration of whichever pose is the nearest: MotionPlanner.
  [[nodiscard]] Result<PlannedMotion> plan(std::span<const Pose> T_world_camera, Way way = Way::any) override;

  [[nodiscard]] std::vector<CameraSample> camera_on_way(const Motion& motion, double every_s) const override;
  /// Looks at straight lines between positions kLookAhead_s apart.
  [[nodiscard]] bool still_free(const Motion& motion, double t_s) const override;
  [[nodiscard]] Result<PlannedMotion> plan_to_stand_by() override;
  /// on_way is called at the samples of the joints, and at the end. invalid_argument for a motion that does not begin
  /// where the arm stands; errors of the joints.
  [[nodiscard]] Result<std::optional<Arrival>> execute(const Motion& motion, const OnWay& on_way = {}) override;
  /// All so far.
  [[nodiscard]] const std::vector<Trajectory>& motions() const { return motions_; }

  /// The arm was put there by other means, such as in an earlier run. invalid_argument outside its limits.
  [[nodiscard]] Status place(const Configuration& q);

  [[nodiscard]] const ArmModel& arm() const { return reachability_.arm(); }
  [[nodiscard]] const Reachability& reachability() const { return reachability_; }
  [[nodiscard]] const ObstacleMap& obstacles() const { return obstacles_; }
  [[nodiscard]] Pose T_world_camera() const { return camera_pose(arm(), q_); }

 private:
  /// The parts that plan, for a map in which nothing has been seen.
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
  /// Whether a motion begins where the arm stands.
  [[nodiscard]] Status check_start(const Motion& motion) const;
  [[nodiscard]] Configuration planned_from() const { return retreat_ ? retreat_->end() : q_; }
  /// With the retreat before it, if there is one.
  void begin_with_retreat(Motion& motion) const;
  [[nodiscard]] Result<PlannedMotion> plan_among(std::span<const Pose> T_world_camera, Way way,
                                                 const Configuration& from, const ObstacleMap& obstacles) const;

  Reachability reachability_;
  MotionPlanner planner_;
  std::shared_ptr<JointController> joints_;
  ObstacleMap fixtures_;  ///< without the map
  ObstacleMap obstacles_;
  Configuration stand_by_;
  Configuration q_;
  Hidden<DrivenWay> way_;
  std::optional<Trajectory> retreat_;  ///< out of the contact in which the arm stands
  std::vector<Trajectory> motions_;
};

}  // namespace saccade
