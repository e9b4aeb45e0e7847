// SPDX-License-Identifier: Apache-2.0
#pragma once
// Robot: what moves the camera; FreeRobot: a camera that flies.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/core/region.hpp"
#include "saccade/core/result.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/robot/refusal.hpp"
#include "saccade/robot/trajectory.hpp"
#include "saccade/sensor/camera.hpp"

namespace saccade {

/// A motion that a robot has found for itself and has not made yet.
struct Motion {
  std::size_t goal{0};                    ///< which of the poses that were asked for
  Pose T_world_camera{Pose::Identity()};  ///< that pose
  Trajectory trajectory;                  ///< of an arm; empty for robots that find their own way
  double retreat_s{0.0};                  ///< its beginning, in which an arm backs out of a contact
};

/// A motion, or why there is none.
struct PlannedMotion {
  std::optional<Motion> motion;
  std::optional<Refusal> refusal;
  std::string why;  ///< of a refusal, for people; may be empty
};

/// The end of a motion.
struct Arrival {
  Pose T_world_camera{Pose::Identity()};  ///< where the camera is, which an arm knows better than the one who asked
  double motion_s{0.0};                   ///< what the way takes a real arm; 0 where that is not known
  bool stopped{false};                    ///< on the way, because the observer said so or the caller cancelled
};

/// Where the camera is on its way.
struct CameraSample {
  double t_s{0.0};  ///< since the motion began
  Pose T_world_camera{Pose::Identity()};
  std::optional<double> time_s{};  ///< on the clock of the robot, where it has one
};
using OnWay = std::function<Advance(const CameraSample& sample)>;

enum class Way : std::uint8_t {
  any,
  straight,  ///< in joint space; for small corrections, where a detour would be absurd
};

/// Carries the camera. One caller at a time.
class Robot {
 public:
  virtual ~Robot() = default;

  /// How an arm stands; nullopt for what is no arm, or does not say.
  [[nodiscard]] virtual std::optional<Configuration> configuration() const { return std::nullopt; }

  /// What the robot must not touch follows the map. Errors: those of the robot's own planner map.
  [[nodiscard]] virtual Status follow(const TsdfSnapshot& map, const Executor& executor);

  /// Space of an unknown map that must be free for the robot to stand where it does and to go through the poses one
  /// after the other, those that it can reach: what the one who starts it there vouches for. Boxes without order.
  [[nodiscard]] virtual Result<std::vector<Box>> swept_by(std::span<const Pose> T_world_camera);

  /// For each pose why it cannot be taken, as far as that can be told without looking for a path; nullopt: it may be.
  [[nodiscard]] virtual std::vector<std::optional<Refusal>> test(std::span<const Pose> T_world_camera,
                                                                 const Executor& executor) const;

  /// The robot's own body in the picture of a sensor that it holds, as it would stand at a pose; empty where it has
  /// none, or does not know it. The robot outlives what is returned, which holds until it moves or follows a map. An
  /// Error: the sensor would see nothing else.
  [[nodiscard]] virtual Result<OwnBody> own_body(const PinholeCamera& sensor) const;

  /// A motion to one of the poses, which are equally good to the caller; nothing moves. Expects one pose at least. An
  /// Error means that the robot itself failed.
  [[nodiscard]] virtual Result<PlannedMotion> plan(std::span<const Pose> T_world_camera, Way way = Way::any) = 0;

  /// Where the camera will be on its way, at multiples of `every_s`, the end left out; empty for robots that do not
  /// know. Expects every_s > 0.
  [[nodiscard]] virtual std::vector<CameraSample> camera_on_way(const Motion& motion, double every_s) const;

  /// Whether the rest of a motion under way, from `t_s` on, touches nothing of the map that was followed last. true for
  /// robots that do not know.
  [[nodiscard]] virtual bool still_free(const Motion& motion, double t_s) const;

  /// A motion back to where the robot stood in the beginning; a refusal where it does not know the way, or the place.
  [[nodiscard]] virtual Result<PlannedMotion> plan_to_stand_by();

  /// Makes the motion that was planned last. `on_way` is called at samples of the camera's path, for robots that know
  /// it, and may stop the motion; configuration() is then that of the sample.
  /// @return nullopt when the robot declines after all, and has not moved. An Error means that its pose is not known.
  [[nodiscard]] virtual Result<std::optional<Arrival>> execute(const Motion& motion, const OnWay& on_way = {}) = 0;

  /// Both: where the camera is then, nullopt when it cannot be there.
  [[nodiscard]] Result<std::optional<Pose>> move_to(const Pose& T_world_camera, Way way = Way::any);
};

/// Reaches every pose, at once, but for those where the camera may not be.
class FreeRobot final : public Robot {
 public:
  /// `allowed` says where the camera's centre may be; empty: anywhere.
  explicit FreeRobot(std::function<bool(const Eigen::Vector3d& p_world)> allowed = {}) : allowed_{std::move(allowed)} {}
  [[nodiscard]] std::vector<std::optional<Refusal>> test(std::span<const Pose> T_world_camera,
                                                         const Executor& executor) const override;
  [[nodiscard]] Result<PlannedMotion> plan(std::span<const Pose> T_world_camera, Way way = Way::any) override;
  [[nodiscard]] Result<std::optional<Arrival>> execute(const Motion& motion, const OnWay& on_way = {}) override;
  [[nodiscard]] const Pose& T_world_camera() const { return T_world_camera_; }

 private:
  [[nodiscard]] bool may_be_at(const Pose& pose) const { return !allowed_ || allowed_(pose.translation()); }
  std::function<bool(const Eigen::Vector3d&)> allowed_;
  Pose T_world_camera_{Pose::Identity()};
};

}  // namespace saccade
