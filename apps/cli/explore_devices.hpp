// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExploreDevices: the camera and the robot of an exploration, simulated or behind a program of the user's.

#include <memory>
#include <optional>

#include "explore_options.hpp"
#include "progress_bar.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/devices/programs.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/trial/masked_camera.hpp"

namespace saccade::cli {

/// Scene that an exploration works on; a real camera, and a scene of supports alone, have no ground truth.
struct ExploreSetup {
  Scene scene;
  std::optional<RayScene> rays;      ///< where the scene has objects
  std::optional<GroundTruth> truth;  ///< for a simulated camera
};

/// Reads the arm that the options name, with its speeds as they say; none where something else carries the camera.
/// Errors: those of find_robot.
[[nodiscard]] Result<std::optional<UrdfArm>> read_described_arm(const ExploreOptions& options);
/// Returns the arm alone. `bar` shows what had to be chosen; it may be nullptr.
[[nodiscard]] Result<std::optional<ArmModel>> read_arm(const ExploreOptions& options, ProgressBar* bar);
/// The built-in scene or file.
[[nodiscard]] Result<ExploreSetup> open_case(const ExploreOptions& options, const Executor& executor);

/// The map that the options name, or one in which nothing is known, in the scene's workspace. invalid_argument for a
/// map with another voxel size or workspace; errors of load_map.
[[nodiscard]] Result<TsdfMap> map_to_begin_with(const ExploreOptions& options, const Scene& scene,
                                                const Executor& executor);

class ExploreDevices {
 public:
  /// Starts what has to be started. Errors: those of the camera and the robot.
  [[nodiscard]] static Result<ExploreDevices> open(const ExploreOptions& options, const ExploreSetup& subject,
                                                   const std::optional<ArmModel>& arm, const Executor& executor);

  /// Takes frames without the arm where that stands in its own picture.
  [[nodiscard]] MaskedCamera& camera() { return camera_; }
  [[nodiscard]] const PinholeCamera& intrinsics() const { return camera_.intrinsics(); }
  [[nodiscard]] Robot& robot() { return camera_.robot(); }
  /// The simulated arm; nullptr: something else carries the camera.
  [[nodiscard]] const PlannedArm* simulated_arm() const { return dynamic_cast<const PlannedArm*>(&camera_.robot()); }
  /// Changes the scene that a simulated camera sees; the fixtures that an arm keeps clear of stay. Errors: those of
  /// simulated_camera.
  [[nodiscard]] Status change_scene(const RayScene& scene, const SimulatedRunConfig& config);
  /// For a dry run: fuses what an arm's camera sees without moving. false: where the camera is, is not known. Errors:
  /// those of the camera.
  [[nodiscard]] Result<bool> look_from_where_it_stands(TsdfMap& map, const Executor& executor);
  /// The arm, if it is one that we move ourselves.
  [[nodiscard]] const ArmModel* arm() const { return camera_.arm(); }
  /// A simulated camera goes on as if it had taken `frames` frames.
  void resume_at(std::size_t frames);
  /// The arm stands as in the interrupted run. invalid_argument.
  [[nodiscard]] Status place_arm(const Configuration& q);

 private:
  explicit ExploreDevices(MaskedCamera camera) : camera_{std::move(camera)} {}

  MaskedCamera camera_;
};

}  // namespace saccade::cli
