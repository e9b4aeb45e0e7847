// SPDX-License-Identifier: Apache-2.0
#pragma once
// SimulatedCamera: what a depth camera measures of a RayScene, noise included.

#include <memory>

#include "saccade/scene/ray_scene.hpp"
#include "saccade/scene/time_of_flight.hpp"
#include "saccade/sensor/camera_source.hpp"
#include "saccade/sensor/noise.hpp"

namespace saccade {

/// Noise as of a Kinect v1: axial noise growing with z², depth in steps of an eighth of a pixel's disparity
/// (8 · 580 px · 0.075 m = 348 steps per 1/m), and returns lost from 70° of incidence on.
[[nodiscard]] DepthNoise kinect_v1_noise(std::uint64_t seed = 1);

struct SimulatedCameraConfig {
  PinholeCamera camera;
  std::optional<DepthNoise> noise{kinect_v1_noise()};  ///< none: exact depth
  /// In place of `noise`: a time-of-flight camera such as a Kinect v2, with its shadow and veil points.
  std::optional<TimeOfFlightConfig> time_of_flight;
  /// Removes what such a camera measures wrongly before the frame is delivered, as its driver would; none: all is kept.
  std::optional<DepthFilterConfig> depth_filter;
  /// Returns from beyond the camera's maximum range, up to here, are not trusted as surfaces but show that the space
  /// before it is free (d = −maximum range). Where nothing is hit at all there is no return, and nothing is learnt.
  double reach_m{8.0};

  [[nodiscard]] Status validate() const;
};

/// One caller at a time. The n-th frame of a seed is the same on every machine and for every thread count, whatever was
/// captured before it.
class SimulatedCamera {
 public:
  /// Errors: those of SimulatedCameraConfig::validate.
  [[nodiscard]] static Result<SimulatedCamera> create(RayScene scene, const SimulatedCameraConfig& config = {});

  [[nodiscard]] const PinholeCamera& camera() const { return config_.camera; }
  [[nodiscard]] const RayScene& scene() const { return scene_; }
  /// Frames captured so far; the next one's number.
  [[nodiscard]] std::size_t frames() const { return frames_; }
  /// Goes on as if so many frames had been captured, for a run that is resumed.
  void resume_at(std::size_t frames) { frames_ = frames; }

  /// What each pixel of the last frame is, of a time-of-flight camera; empty before the first frame and for others. A
  /// pixel beyond the maximum range is no_return.
  [[nodiscard]] const Image<MeasuredPixel>& truth() const { return truth_; }

  /// The next frame, from a pose. Expects a finite pose. Cost: RayScene::render.
  [[nodiscard]] Frame capture(const Pose& T_world_camera, const Executor& executor = {});
  /// The same with something before the scene, such as the arm that holds the camera (ArmSilhouette::depth): `before`
  /// is its exact depth along z, of the camera's size (a contract), 0 where it is not. What is nearer is seen; nearer
  /// than the camera's minimum range it gives no return and hides what is behind it. It is dark grey, and loses no
  /// return for grazing. Noise falls on what is seen. It throws no shadow, nor mixes with the scene at its edges.
  [[nodiscard]] Frame capture(const Pose& T_world_camera, const DepthImage& before, const Executor& executor = {});

 private:
  SimulatedCamera(RayScene scene, const SimulatedCameraConfig& config, std::shared_ptr<const DepthFilter> filter)
      : scene_{std::move(scene)}, config_{config}, filter_{std::move(filter)} {}
  [[nodiscard]] Frame frame_of(ExactFrame exact, const Pose& T_world_camera, const DepthImage* before,
                               const Executor& executor);
  [[nodiscard]] DepthImage measured(ExactFrame& exact, const Pose& T_world_camera, const DepthImage* before,
                                    const Executor& executor);

  RayScene scene_;
  SimulatedCameraConfig config_;
  std::shared_ptr<const DepthFilter> filter_;  ///< null: none
  std::size_t frames_{0};
  Image<MeasuredPixel> truth_;
};

}  // namespace saccade
