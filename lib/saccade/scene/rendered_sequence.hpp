// SPDX-License-Identifier: Apache-2.0
#pragma once
// RenderedSequence: a hand-held RGB-D camera moving before a scene, as a CameraSource, with the truth of every pixel.

#include <cstdint>
#include <optional>
#include <vector>

#include "saccade/scene/color_camera.hpp"
#include "saccade/scene/paint.hpp"
#include "saccade/scene/ray_scene.hpp"
#include "saccade/scene/time_of_flight.hpp"
#include "saccade/sensor/camera_source.hpp"
#include "saccade/sensor/noise.hpp"

namespace saccade {

/// Where a hand carries the camera: it looks at a target that wanders in a box, from directions and distances that
/// swing at rates without a common measure, and trembles by some millimetres.
struct HandHeldPath {
  Box targets;
  double azimuth_from_rad{0.0};  ///< of the camera seen from the target, about z
  double azimuth_to_rad{0.0};
  double elevation_from_rad{0.0};
  double elevation_to_rad{0.0};
  double distance_from_m{0.9};
  double distance_to_m{1.4};
  double tremor_m{0.0015};
  double roll_rad{0.06};
};
/// Expects frames ≥ 1. The whole path whatever the number of frames; a seed shifts the swings.
[[nodiscard]] std::vector<Pose> hand_held_poses(const HandHeldPath& path, std::size_t frames, std::uint64_t seed = 1);

/// Errors of the delivered poses: a drift that changes smoothly within so many frames, and jitter; normal, per axis.
struct PoseNoise {
  double drift_m{0.004};
  double drift_rad{0.003};
  double drift_frames{60.0};
  double jitter_m{0.0005};
  double jitter_rad{0.0005};
  std::uint64_t seed{1};
};
[[nodiscard]] std::vector<Pose> with_noise(const std::vector<Pose>& T_world_camera, const PoseNoise& noise);

struct RenderedSequenceConfig {
  PinholeCamera camera;
  ColorCameraConfig color;
  std::optional<PoseNoise> pose_noise{PoseNoise{}};
  std::optional<DepthNoise> depth_noise;             ///< of a structured-light camera; none: exact
  double lateral_noise_px{0.0};                      ///< standard deviation, with depth_noise
  std::optional<TimeOfFlightConfig> time_of_flight;  ///< in place of both
};

struct SequenceTruth {
  Pose T_world_camera;         ///< without noise
  DepthImage depth;            ///< exact
  Image<std::uint16_t> label;  ///< SegmentTable's; 0 where nothing is within the range
  double gain{1.0};
};

/// One caller at a time. The n-th frame is the same on every machine and for every thread count. Depth is that of one
/// ray per pixel; colour is the mean light of 4×4 rays where the pixel's neighbours are of another segment or body, or
/// it lies in print, and of one ray elsewhere. A lamp shines from 2.5 m over the middle of the workspace, besides light
/// from everywhere. Nothing throws a shadow, and nothing is blurred by motion.
class RenderedSequence final : public CameraSource {
 public:
  /// invalid_argument as the parts of the configuration, or without poses.
  [[nodiscard]] static Result<RenderedSequence> create(RayScene scene, std::vector<Pose> T_world_camera,
                                                       const RenderedSequenceConfig& config, Executor executor = {});

  [[nodiscard]] const PinholeCamera& camera() const override { return config_.camera; }
  [[nodiscard]] std::optional<std::size_t> size() const override { return true_poses_.size(); }
  [[nodiscard]] Result<std::optional<Frame>> next() override;

  /// Of the frame that next() delivered last.
  [[nodiscard]] const SequenceTruth& truth() const { return truth_; }
  [[nodiscard]] const SegmentTable& segments() const { return segments_; }

 private:
  RenderedSequence(RayScene scene, std::vector<Pose> true_poses, std::vector<Pose> poses,
                   const RenderedSequenceConfig& config, Executor executor);
  [[nodiscard]] LightImage render_light(const Pose& T_world_camera);
  [[nodiscard]] DepthImage measured(const Pose& T_world_camera) const;

  RayScene scene_;
  SegmentTable segments_;
  std::vector<Pose> T_object_world_;
  std::vector<Pose> true_poses_;
  std::vector<Pose> poses_;
  RenderedSequenceConfig config_;
  Executor executor_;
  std::size_t next_{0};
  double gain_{1.0};
  SequenceTruth truth_;
};

}  // namespace saccade
