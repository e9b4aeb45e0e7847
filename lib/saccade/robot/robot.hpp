// SPDX-License-Identifier: Apache-2.0
#pragma once
// Robot: moves the camera. FreeRobot: a camera that flies.

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

/// Motion that a robot has planned and not yet executed.
struct Motion {
  std::size_t goal{0};                    ///< index of the requested pose that it reaches
  Pose T_world_camera{Pose::Identity()};  ///< that pose
  Trajectory trajectory;                  ///< the arm's motion; empty for robots that plan their own paths
  double retreat_s{0.0};                  ///< duration of the initial retreat, in which an arm backs out of a contact
};

/// A motion, or the reason why there is none.
struct PlannedMotion {
  std::optional<Motion> motion;
  std::optional<Refusal> refusal;
  std::string why;  ///< explanation of the refusal for people; may be empty
};

/// End of a motion.
struct Arrival {
  Pose T_world_camera{Pose::Identity()};  ///< final camera pose, as the robot measures it
  double motion_s{0.0};                   ///< duration on a real arm; 0 where unknown
  bool stopped{false};                    ///< early, because the observer or the caller asked for it
};

/// Camera pose during a motion.
struct MotionSample {
  double t_s{0.0};  ///< since the motion began
  Pose T_world_camera{Pose::Identity()};
  std::optional<double> time_s{};  ///< on the robot's clock, where it has one
};
using MotionObserver = std::function<Advance(const MotionSample& sample)>;

enum class MotionKind : std::uint8_t {
  planned,
  direct,  ///< in joint space; for small corrections, where a detour would be absurd
};

/// Robot that carries the camera. One caller at a time.
class Robot {
 public:
  virtual ~Robot() = default;

  /// Returns the arm's configuration; nullopt for robots that are not arms or do not report it.
  [[nodiscard]] virtual std::optional<Configuration> configuration() const { return std::nullopt; }

  /// Updates the robot's obstacles from the map. Errors: those of the robot's own planner map.
  [[nodiscard]] virtual Status follow(const TsdfSnapshot& map, const Executor& executor);

  /// Returns the volume that the robot occupies and sweeps on its way through the poses, one after the other, as far as
  /// it can reach them. In an unknown map the caller guarantees that this volume is free. Boxes in no particular order.
  [[nodiscard]] virtual Result<std::vector<Box>> swept_volume(std::span<const Pose> T_world_camera);

  /// Returns for each pose why it cannot be taken, without planning a path; nullopt where it may be reachable.
  [[nodiscard]] virtual std::vector<std::optional<Refusal>> test(std::span<const Pose> T_world_camera,
                                                                 const Executor& executor) const;

  /// Returns a function that renders the robot's own body in the image of a sensor that it holds, as it would stand at
  /// a pose. The function is empty where the robot has no body or does not know it. The robot must outlive it; it is
  /// valid until the robot moves or follows a map. Answers an Error when the sensor would see nothing but the robot.
  [[nodiscard]] virtual Result<OwnBody> own_body(const PinholeCamera& sensor) const;

  /// Plans a motion to one of the poses, which are equally good to the caller. Nothing moves. Expects at least one
  /// pose. An Error means that the robot itself failed.
  [[nodiscard]] virtual Result<PlannedMotion> plan(std::span<const Pose> T_world_camera,
                                                   MotionKind way = MotionKind::planned) = 0;

  /// Returns the camera's poses during a motion, at multiples of `every_s` without the end; empty where unknown.
  /// Expects every_s > 0.
  [[nodiscard]] virtual std::vector<MotionSample> camera_on_way(const Motion& motion, double every_s) const;

  /// Tells whether the rest of a running motion, from `t_s` on, is free of collision in the last map followed. true
  /// where unknown.
  [[nodiscard]] virtual bool still_free(const Motion& motion, double t_s) const;

  /// Plans a motion back to the stand-by pose; a refusal where the robot knows no path to it, or no such pose.
  [[nodiscard]] virtual Result<PlannedMotion> plan_to_stand_by();

  /// Executes the last planned motion. Robots that know the camera's path call `on_way` at samples of it, which may
  /// stop the motion; configuration() is then that of the sample.
  /// @return nullopt when the robot declines after all, and has not moved. After an Error its pose is unknown.
  [[nodiscard]] virtual Result<std::optional<Arrival>> execute(const Motion& motion,
                                                               const MotionObserver& on_way = {}) = 0;

  /// Plans and executes: returns the final camera pose, or nullopt when the camera cannot get there.
  [[nodiscard]] Result<std::optional<Pose>> move_to(const Pose& T_world_camera, MotionKind way = MotionKind::planned);
};

/// Robot that reaches every pose at once, except where the camera may not be.
class FreeRobot final : public Robot {
 public:
  /// Creates the robot. `allowed` tells where the camera's centre may be; empty means anywhere.
  explicit FreeRobot(std::function<bool(const Eigen::Vector3d& p_world)> allowed = {}) : allowed_{std::move(allowed)} {}
  [[nodiscard]] std::vector<std::optional<Refusal>> test(std::span<const Pose> T_world_camera,
                                                         const Executor& executor) const override;
  [[nodiscard]] Result<PlannedMotion> plan(std::span<const Pose> T_world_camera,
                                           MotionKind way = MotionKind::planned) override;
  [[nodiscard]] Result<std::optional<Arrival>> execute(const Motion& motion,
                                                       const MotionObserver& on_way = {}) override;
  [[nodiscard]] const Pose& T_world_camera() const { return T_world_camera_; }

 private:
  [[nodiscard]] bool may_be_at(const Pose& pose) const { return !allowed_ || allowed_(pose.translation()); }
  std::function<bool(const Eigen::Vector3d&)> allowed_;
  Pose T_world_camera_{Pose::Identity()};
};

}  // namespace saccade
