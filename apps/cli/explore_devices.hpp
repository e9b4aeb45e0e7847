// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExploreDevices: the camera and the robot of an exploration, simulated or behind a program of the user's.

#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "explore_options.hpp"
#include "saccade/io/external_camera.hpp"
#include "saccade/io/external_robot.hpp"

namespace saccade::cli {

/// What an exploration works on; a real camera has no truth to compare with.
struct ExploreCase {
  Scene scene;
  std::optional<RayScene> rays;  ///< of a scene with objects
  std::optional<Truth> truth;    ///< for a simulated camera
};

/// The built-in scene or file.
[[nodiscard]] Result<ExploreCase> open_case(const ExploreOptions& options, const Executor& executor);

class ExploreDevices {
 public:
  /// Starts what has to be started. Errors: those of the camera and the robot.
  [[nodiscard]] static Result<ExploreDevices> open(const ExploreOptions& options, const ExploreCase& subject,
                                                   const Executor& executor);

  [[nodiscard]] const PinholeCamera& camera() const;
  [[nodiscard]] Robot& robot() { return *robot_; }
  /// Takes a frame and remembers it.
  [[nodiscard]] Result<Frame> observe(const Pose& T_world_camera);
  [[nodiscard]] std::size_t frames() const { return frames_; }
  /// Goes on as if so many frames had been taken.
  void resume_at(std::size_t frames);
  /// The frames since the last call.
  std::vector<Frame> take_frames() { return std::exchange(seen_, {}); }

 private:
  using Camera = std::variant<SimulatedCamera, ExternalCamera>;
  ExploreDevices(Camera camera, std::unique_ptr<Robot> robot, const Executor& executor)
      : camera_{std::move(camera)}, robot_{std::move(robot)}, executor_{executor} {}

  Camera camera_;
  std::unique_ptr<Robot> robot_;
  Executor executor_;
  std::size_t frames_{0};
  std::vector<Frame> seen_;
};

}  // namespace saccade::cli
