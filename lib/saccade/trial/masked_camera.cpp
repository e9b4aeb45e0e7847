// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/masked_camera.hpp"

namespace saccade {

Result<MaskedCamera> MaskedCamera::create(SimulatedCamera camera, std::unique_ptr<Robot> robot, const ArmModel* arm,
                                          const Executor& executor) {
  SACCADE_EXPECTS(robot != nullptr);
  MaskedCamera carried{camera.camera(), std::move(robot), executor};
  carried.simulated_ = std::move(camera);
  SACCADE_CHECK(carried.draw(arm));
  return carried;
}

Result<MaskedCamera> MaskedCamera::create(std::unique_ptr<Camera> camera, std::unique_ptr<Robot> robot,
                                          const ArmModel* arm, const Executor& executor) {
  SACCADE_EXPECTS(robot != nullptr && camera != nullptr);
  MaskedCamera carried{camera->intrinsics(), std::move(robot), executor};
  carried.camera_ = std::move(camera);
  SACCADE_CHECK(carried.draw(arm));
  return carried;
}

Status MaskedCamera::draw(const ArmModel* arm) {
  if (arm == nullptr) return {};
  SACCADE_TRY(ArmSilhouette silhouette, ArmSilhouette::create(*arm, intrinsics_));
  silhouette_ = std::make_shared<const ArmSilhouette>(std::move(silhouette));
  return {};
}

Frame MaskedCamera::simulate(const Pose& T_world_camera, const std::optional<Configuration>& q) {
  if (!silhouette_ || !q || !silhouette_->in_picture(*q)) return simulated_->capture(T_world_camera, executor_);
  return simulated_->capture(T_world_camera, silhouette_->depth(*q, executor_), executor_);
}

Result<Frame> MaskedCamera::capture(const Pose& T_world_camera) {
  const std::optional<Configuration> q = robot_->configuration();
  SACCADE_TRY(Frame frame, simulated_ ? Result<Frame>{simulate(T_world_camera, q)} : camera_->capture(T_world_camera));
  if (silhouette_ && q) {
    SACCADE_TRY([[maybe_unused]] const std::size_t masked, silhouette_->mask(*q, frame.depth, executor_));
  }
  return frame;
}

}  // namespace saccade
