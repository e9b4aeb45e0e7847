// SPDX-License-Identifier: Apache-2.0
#pragma once
// CarriedCamera: a depth camera and the robot that carries it.

#include <memory>
#include <optional>

#include "saccade/arm/arm_silhouette.hpp"
#include "saccade/robot/robot.hpp"
#include "saccade/scene/simulated_camera.hpp"
#include "saccade/sensor/camera.hpp"

namespace saccade {

/// An arm that holds the camera may stand in its own picture. A simulated camera sees it there; of every camera's
/// frames its pixels are taken out (ArmSilhouette), so that nothing is learnt of them. One caller at a time.
class CarriedCamera final : public Camera {
 public:
  /// @param arm the robot's own body; nullptr: it is never in the picture. Errors: those of ArmSilhouette::create.
  [[nodiscard]] static Result<CarriedCamera> create(SimulatedCamera camera, std::unique_ptr<Robot> robot,
                                                    const ArmModel* arm, const Executor& executor);
  /// The same with a camera of any other kind.
  [[nodiscard]] static Result<CarriedCamera> create(std::unique_ptr<Camera> camera, std::unique_ptr<Robot> robot,
                                                    const ArmModel* arm, const Executor& executor);

  [[nodiscard]] const PinholeCamera& intrinsics() const override { return intrinsics_; }
  [[nodiscard]] Robot& robot() { return *robot_; }
  [[nodiscard]] const Robot& robot() const { return *robot_; }
  /// nullptr: none is known.
  [[nodiscard]] const ArmModel* arm() const { return silhouette_ ? &silhouette_->arm() : nullptr; }
  /// nullptr: the camera is of another kind.
  [[nodiscard]] SimulatedCamera* simulated() { return simulated_ ? &*simulated_ : nullptr; }

  /// A frame from where the camera is, without the arm. Errors: those of the camera, and size_mismatch for an image
  /// that is not of its size. The same for every thread count, where the camera is simulated.
  [[nodiscard]] Result<Frame> capture(const Pose& T_world_camera) override;

 private:
  CarriedCamera(const PinholeCamera& intrinsics, std::unique_ptr<Robot> robot, const Executor& executor)
      : intrinsics_{intrinsics}, robot_{std::move(robot)}, executor_{executor} {}
  [[nodiscard]] Status draw(const ArmModel* arm);
  [[nodiscard]] Frame simulate(const Pose& T_world_camera, const std::optional<Configuration>& q);

  PinholeCamera intrinsics_;
  std::unique_ptr<Robot> robot_;
  Executor executor_;
  std::optional<SimulatedCamera> simulated_;
  std::unique_ptr<Camera> camera_;                   ///< in place of a simulated one
  std::shared_ptr<const ArmSilhouette> silhouette_;  ///< of the arm, if there is one
};

}  // namespace saccade
