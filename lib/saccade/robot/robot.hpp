// SPDX-License-Identifier: Apache-2.0
#pragma once
// Robot: what moves the camera; FreeRobot: a camera that flies.

#include <functional>
#include <optional>
#include <utility>

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// Carries the camera. One caller at a time.
class Robot {
 public:
  virtual ~Robot() = default;
  /// Brings the camera to a pose.
  /// @return where the camera is then, which an arm knows better than the one who asked; nullopt when the pose cannot
  ///         be reached, and nothing has moved. An Error means that the robot itself failed: its pose is not known.
  [[nodiscard]] virtual Result<std::optional<Pose>> move_to(const Pose& T_world_camera) = 0;
};

/// Reaches every pose, at once, but for those where the camera may not be.
class FreeRobot final : public Robot {
 public:
  /// `allowed` says where the camera's centre may be; empty: anywhere.
  explicit FreeRobot(std::function<bool(const Eigen::Vector3d& p_world)> allowed = {}) : allowed_{std::move(allowed)} {}
  [[nodiscard]] Result<std::optional<Pose>> move_to(const Pose& T_world_camera) override;
  [[nodiscard]] const Pose& T_world_camera() const { return T_world_camera_; }

 private:
  std::function<bool(const Eigen::Vector3d&)> allowed_;
  Pose T_world_camera_{Pose::Identity()};
};

}  // namespace saccade
