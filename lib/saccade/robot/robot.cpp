// SPDX-License-Identifier: Apache-2.0
#include "saccade/robot/robot.hpp"

namespace saccade {

Status Robot::follow(const TsdfSnapshot& /*map*/, const Executor& /*executor*/) { return {}; }

Result<std::vector<Box>> Robot::swept_volume(std::span<const Pose> /*T_world_camera*/) { return std::vector<Box>{}; }

std::vector<std::optional<Refusal>> Robot::test(std::span<const Pose> T_world_camera,
                                                const Executor& /*executor*/) const {
  return std::vector<std::optional<Refusal>>(T_world_camera.size());
}

Result<OwnBody> Robot::own_body(const PinholeCamera& /*sensor*/) const { return OwnBody{}; }

std::vector<MotionSample> Robot::camera_on_way(const Motion& /*motion*/, double /*every_s*/) const { return {}; }

bool Robot::still_free(const Motion& /*motion*/, double /*t_s*/) const { return true; }

Result<PlannedMotion> Robot::plan_to_stand_by() {
  return PlannedMotion{std::nullopt, Refusal::declined, "the robot has no stand-by"};
}

Result<std::optional<Pose>> Robot::move_to(const Pose& T_world_camera, MotionKind way) {
  SACCADE_TRY(const PlannedMotion planned, plan(std::span{&T_world_camera, 1}, way));
  if (!planned.motion) return std::optional<Pose>{};
  SACCADE_TRY(const std::optional<Arrival> arrival, execute(*planned.motion));
  return arrival ? std::optional{arrival->T_world_camera} : std::nullopt;
}

std::vector<std::optional<Refusal>> FreeRobot::test(std::span<const Pose> T_world_camera,
                                                    const Executor& executor) const {
  constexpr std::size_t kGrain{64};
  std::vector<std::optional<Refusal>> refusals(T_world_camera.size());
  executor.parallel_for(refusals.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!may_be_at(T_world_camera[i])) refusals[i] = Refusal::goal_in_collision;
    }
  });
  return refusals;
}

Result<PlannedMotion> FreeRobot::plan(std::span<const Pose> T_world_camera, MotionKind /*way*/) {
  SACCADE_EXPECTS(!T_world_camera.empty());
  for (std::size_t i = 0; i < T_world_camera.size(); ++i) {
    if (may_be_at(T_world_camera[i])) return PlannedMotion{Motion{i, T_world_camera[i], {}}, std::nullopt, ""};
  }
  return PlannedMotion{std::nullopt, Refusal::goal_in_collision, "the camera may not be there"};
}

Result<std::optional<Arrival>> FreeRobot::execute(const Motion& motion, const MotionObserver& on_way) {
  T_world_camera_ = motion.T_world_camera;
  if (on_way) on_way({0.0, T_world_camera_});
  return std::optional{Arrival{T_world_camera_, 0.0}};
}

}  // namespace saccade
