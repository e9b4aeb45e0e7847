// SPDX-License-Identifier: Apache-2.0
#pragma once
// SimulatedCamera: measurements of a RayScene by a depth camera, with noise. capture_time_of_flight: measurements of a
// time-of-flight camera with its artefacts. Thesis §3.1.3, Figs. 3.10–3.12.

#include <cstdint>
#include <memory>

#include "saccade/scene/ray_scene.hpp"
#include "saccade/sensor/camera.hpp"
#include "saccade/sensor/kinect_v2_filter.hpp"
#include "saccade/sensor/noise.hpp"

namespace saccade {

/// How a pixel combines several depths: their mean, or the depth of the mean phase of light modulated at 16 MHz (the
/// Kinect v2's lowest frequency). Both weigh depths by 1/z², as light returns.
enum class EdgeModel : std::uint8_t { mean_depth, mean_phase };

struct TimeOfFlightConfig {
  double baseline_m{0.08};                      ///< from the camera to the emitter, along the camera's x axis
  EmitterSide emitter_side{EmitterSide::left};  ///< as in DepthFilterConfig
  double shadow_bias_m{0.05};  ///< bias of points that the emitter does not light: light reaches them by detours
  double shadow_sigma_m{0.1};  ///< standard deviation of these points
  double footprint_px{1.0};    ///< edge of the square that a pixel sees
  int footprint_samples{4};    ///< rays along each edge of the square, where it may hold an edge
  EdgeModel edge_model{EdgeModel::mean_depth};
  double veil_distance_m{0.03};  ///< a mixed depth farther than this from everything that the pixel sees is a veil
                                 ///< point
  DepthNoise noise{0.002, 0.0, 0.0, 0.0, 0.0};  ///< noise of all other points; its seed is also that of the shadow
                                                ///< points

  /// Answers invalid_argument, as DepthFilterConfig and DepthNoise, or for a footprint outside 0 to 5 pixels or 2 to 16
  /// samples.
  [[nodiscard]] Status validate() const;
};

/// Ground truth of a pixel: what DepthFilter should keep or remove.
enum class MeasuredPixel : std::uint8_t { no_return, good, in_shadow, veil };

struct TimeOfFlightFrame {
  DepthImage depth;            ///< as measured
  DepthImage exact;            ///< along each pixel's central ray
  Image<MeasuredPixel> truth;  ///< all three images have one size
};

/// Captures a frame. A point that the emitter does not light is measured with shadow_bias_m and shadow_sigma_m. At
/// edges, a pixel measures a mean over its footprint; the result is a veil point where it lies farther than
/// veil_distance_m from everything in the footprint. All else is measured with `noise`. The n-th frame of a seed is
/// equal for every thread count. Expects a finite pose. Answers invalid_argument as validate. O(pixels · log
/// triangles).
[[nodiscard]] Result<TimeOfFlightFrame> capture_time_of_flight(const RayScene& scene, const PinholeCamera& camera,
                                                               const TimeOfFlightConfig& config,
                                                               const Pose& T_world_camera, std::uint64_t frame = 0,
                                                               const Executor& executor = {});

/// Measures a frame whose exact depth is known. before: depth of an object in front of the scene, 0 elsewhere. It
/// appears in `exact` where it hides the scene, is measured without mixing, and casts no shadow. Expects a valid camera
/// and configuration, and images of the camera's size.
[[nodiscard]] TimeOfFlightFrame measure_time_of_flight(const RayScene& scene, const PinholeCamera& camera,
                                                       const TimeOfFlightConfig& config, const Pose& T_world_camera,
                                                       DepthImage exact, const DepthImage* before, std::uint64_t frame,
                                                       const Executor& executor);

/// Returns the noise of a Kinect v1: axial noise growing with z², depth in steps of an eighth of a pixel's disparity (8
/// · 580 px · 0.075 m = 348 steps per 1/m), and returns lost from 70° of incidence on.
[[nodiscard]] DepthNoise kinect_v1_noise(std::uint64_t seed = 1);

struct SimulatedCameraConfig {
  PinholeCamera camera;
  std::optional<DepthNoise> noise{kinect_v1_noise()};  ///< none: exact depth
  /// Replaces `noise`: a time-of-flight camera such as a Kinect v2, with its shadow and veil points.
  std::optional<TimeOfFlightConfig> time_of_flight;
  /// Removes wrong measurements of such a camera before the frame is delivered, as its driver would; none: all are
  /// kept.
  std::optional<DepthFilterConfig> depth_filter;
  /// Range up to which returns beyond the camera's maximum range show that the space before is free (d = −maximum
  /// range), though they are not trusted as surfaces. Where nothing is hit at all there is no return.
  double reach_m{8.0};

  [[nodiscard]] Status validate() const;
};

/// Simulated camera. One caller at a time. The n-th frame of a seed is equal on every machine and for every thread
/// count, whatever was captured before it.
class SimulatedCamera {
 public:
  /// Creates the camera. Errors: those of SimulatedCameraConfig::validate.
  [[nodiscard]] static Result<SimulatedCamera> create(RayScene scene, const SimulatedCameraConfig& config = {});

  [[nodiscard]] const PinholeCamera& camera() const { return config_.camera; }
  [[nodiscard]] const RayScene& scene() const { return scene_; }
  /// Returns the number of frames captured so far, which is the next one's index.
  [[nodiscard]] std::size_t frames() const { return frames_; }
  /// Continues as if `frames` frames had been captured, to resume a run.
  void resume_at(std::size_t frames) { frames_ = frames; }

  /// Returns the ground truth of each pixel of a time-of-flight camera's last frame; empty before the first frame and
  /// for other cameras. A pixel beyond the maximum range is no_return.
  [[nodiscard]] const Image<MeasuredPixel>& truth() const { return truth_; }

  /// Captures the next frame from a pose. Expects a finite pose. Cost: RayScene::render.
  [[nodiscard]] Frame capture(const Pose& T_world_camera, const Executor& executor = {});
  /// Captures a frame with an object in front of the scene, such as the arm that holds the camera
  /// (ArmSilhouette::depth). `before` is its exact depth along z, of the camera's size (a contract), 0 elsewhere. The
  /// nearer surface is visible; nearer than the camera's minimum range the object gives no return and hides what is
  /// behind it. It is dark grey, and loses no return for grazing. Noise is added to the result. The object casts no
  /// shadow, and does not mix with the scene at its edges.
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
  std::shared_ptr<const DepthFilter> filter_;  ///< null: no filter
  std::size_t frames_{0};
  Image<MeasuredPixel> truth_;
};

}  // namespace saccade
