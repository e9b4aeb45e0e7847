// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExploreDevices: the camera and the robot of an exploration, simulated or behind a program of the user's.

#include <memory>
#include <optional>
#include <vector>

#include "explore_options.hpp"
#include "saccade/explore/carried_camera.hpp"
#include "saccade/io/external_camera.hpp"
#include "saccade/io/external_robot.hpp"

namespace saccade::cli {

/// What an exploration works on; a real camera has no truth to compare with.
struct ExploreCase {
  Scene scene;
  std::optional<RayScene> rays;  ///< of a scene with objects
  std::optional<Truth> truth;    ///< for a simulated camera
};

/// The arm that the options name; none where something else carries the camera. Errors: those of find_robot.
[[nodiscard]] Result<std::optional<ArmModel>> read_arm(const ExploreOptions& options);
/// The built-in scene or file.
[[nodiscard]] Result<ExploreCase> open_case(const ExploreOptions& options, const Executor& executor);

class ExploreDevices {
 public:
  /// Starts what has to be started. Errors: those of the camera and the robot.
  [[nodiscard]] static Result<ExploreDevices> open(const ExploreOptions& options, const ExploreCase& subject,
                                                   const std::optional<ArmModel>& arm, const Executor& executor);

  [[nodiscard]] const PinholeCamera& camera() const { return camera_.camera(); }
  [[nodiscard]] Robot& robot() { return camera_.robot(); }
  /// The same, as it moves in simulation.
  [[nodiscard]] const SimulatedRobot* simulated_arm() const {
    return dynamic_cast<const SimulatedRobot*>(&camera_.robot());
  }
  /// What a simulated camera sees from now on; the fixtures that an arm keeps clear of stay. Errors: those of
  /// simulated_camera.
  [[nodiscard]] Status change_scene(const RayScene& scene, const SimulatedRunConfig& config);
  /// The arm, if it is one that we move ourselves.
  [[nodiscard]] const ArmModel* arm() const { return camera_.arm(); }
  /// Takes a frame, without the arm where that stands in its own picture, and remembers it.
  [[nodiscard]] Result<Frame> observe(const Pose& T_world_camera);
  [[nodiscard]] std::size_t frames() const { return frames_; }
  /// Goes on as if so many frames had been taken.
  void resume_at(std::size_t frames);
  /// The arm stands as in the interrupted run. invalid_argument.
  [[nodiscard]] Status place_arm(const Configuration& q);
  /// The frames since the last call.
  std::vector<Frame> take_frames() { return std::exchange(seen_, {}); }

 private:
  ExploreDevices(CarriedCamera camera, const Executor& executor) : camera_{std::move(camera)}, executor_{executor} {}

  CarriedCamera camera_;
  Executor executor_;
  std::size_t frames_{0};
  std::vector<Frame> seen_;
};

}  // namespace saccade::cli
