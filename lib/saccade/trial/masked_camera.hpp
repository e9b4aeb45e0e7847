// SPDX-License-Identifier: Apache-2.0
#pragma once
// MaskedCamera: a depth camera and the robot that carries it, with the robot masked out of the images.

#include <memory>
#include <optional>

#include "saccade/arm/arm_silhouette.hpp"
#include "saccade/robot/robot.hpp"
#include "saccade/scene/simulated_camera.hpp"
#include "saccade/sensor/camera.hpp"

namespace saccade {

/// Camera on a robot. An arm that holds the camera may appear in its own image; a simulated camera renders it there.
/// Its pixels are removed from every camera's frames (ArmSilhouette), so the map learns nothing from them. One caller
/// at a time.
class MaskedCamera final : public Camera {
 public:
  /// @param arm the robot's own body; nullptr: it never appears in the image. Errors: those of ArmSilhouette::create.
  [[nodiscard]] static Result<MaskedCamera> create(SimulatedCamera camera, std::unique_ptr<Robot> robot,
                                                   const ArmModel* arm, const Executor& executor);
  /// Creates it with any other camera.
  [[nodiscard]] static Result<MaskedCamera> create(std::unique_ptr<Camera> camera, std::unique_ptr<Robot> robot,
                                                   const ArmModel* arm, const Executor& executor);

  [[nodiscard]] const PinholeCamera& intrinsics() const override { return intrinsics_; }
  [[nodiscard]] Robot& robot() { return *robot_; }
  [[nodiscard]] const Robot& robot() const { return *robot_; }
  /// Returns the arm; nullptr where none is known.
  [[nodiscard]] const ArmModel* arm() const { return silhouette_ ? &silhouette_->arm() : nullptr; }
  /// Returns the simulated camera; nullptr for others.
  [[nodiscard]] SimulatedCamera* simulated() { return simulated_ ? &*simulated_ : nullptr; }

  /// Captures a frame from the camera's current pose, without the arm. Errors: those of the camera, and size_mismatch
  /// for an image of another size. With a simulated camera, the thread count never changes the result.
  [[nodiscard]] Result<Frame> capture(const Pose& T_world_camera) override;

 private:
  MaskedCamera(const PinholeCamera& intrinsics, std::unique_ptr<Robot> robot, const Executor& executor)
      : intrinsics_{intrinsics}, robot_{std::move(robot)}, executor_{executor} {}
  [[nodiscard]] Status draw(const ArmModel* arm);
  [[nodiscard]] Frame simulate(const Pose& T_world_camera, const std::optional<Configuration>& q);

  PinholeCamera intrinsics_;
  std::unique_ptr<Robot> robot_;
  Executor executor_;
  std::optional<SimulatedCamera> simulated_;
  std::unique_ptr<Camera> camera_;                   ///< used instead of a simulated one
  std::shared_ptr<const ArmSilhouette> silhouette_;  ///< silhouette of the arm, if there is one
};

}  // namespace saccade
