// SPDX-License-Identifier: Apache-2.0
#pragma once
// capture_time_of_flight: what a time-of-flight camera such as the Kinect v2 measures of a RayScene, and what is wrong
// with it, pixel by pixel.  Thesis §3.1.3, Figs. 3.10–3.12.

#include <cstdint>

#include "saccade/scene/ray_scene.hpp"
#include "saccade/sensor/kinect_v2_filter.hpp"
#include "saccade/sensor/noise.hpp"

namespace saccade {

/// What a pixel measures of several depths: their mean, or the depth of the mean phase of light modulated with 16 MHz
/// (the Kinect v2's lowest frequency); both weighted by 1/z² as light returns.
enum class EdgeModel : std::uint8_t { mean_depth, mean_phase };

struct TimeOfFlightConfig {
  double baseline_m{0.08};                      ///< from the camera to the emitter, along the camera's x axis
  EmitterSide emitter_side{EmitterSide::left};  ///< as DepthFilterConfig has it
  double shadow_bias_m{0.05};  ///< points that the emitter does not light are too far: light reaches them by detours
  double shadow_sigma_m{0.1};  ///< standard deviation of such points
  double footprint_px{1.0};    ///< edge of the square that a pixel sees
  int footprint_samples{4};    ///< rays along each edge of it, where it may hold an edge
  EdgeModel edge_model{EdgeModel::mean_depth};
  double veil_distance_m{0.03};  ///< a mixed depth farther than this from all that the pixel sees is a veil point
  DepthNoise noise{0.002, 0.0, 0.0, 0.0, 0.0};  ///< of all other points; its seed is that of the shadow points too

  /// invalid_argument, as DepthFilterConfig and DepthNoise, or for a footprint that is not within 0 and 5 pixels or not
  /// of 2 to 16 samples.
  [[nodiscard]] Status validate() const;
};

/// The truth about a pixel: what DepthFilter should keep, and what it should remove.
enum class MeasuredPixel : std::uint8_t { no_return, good, in_shadow, veil };

struct TimeOfFlightFrame {
  DepthImage depth;            ///< as measured
  DepthImage exact;            ///< along each pixel's central ray
  Image<MeasuredPixel> truth;  ///< all three of one size
};

/// A point that the emitter does not light is measured with shadow_bias_m and shadow_sigma_m. At edges, a pixel
/// measures a mean over its footprint; that is a veil point where it lies farther than veil_distance_m from all that
/// the footprint holds. Everything else is measured with `noise`. The n-th frame of a seed is the same for every thread
/// count. Expects a finite pose. invalid_argument as validate. O(pixels · log triangles).
[[nodiscard]] Result<TimeOfFlightFrame> capture_time_of_flight(const RayScene& scene, const PinholeCamera& camera,
                                                               const TimeOfFlightConfig& config,
                                                               const Pose& T_world_camera, std::uint64_t frame = 0,
                                                               const Executor& executor = {});

/// The same where the exact depth is known. before: of something before the scene, 0 where it is not; it is in `exact`
/// where it hides the scene, is measured without mixing, and throws no shadow. Expects a valid camera and
/// configuration, and images of the camera's size.
[[nodiscard]] TimeOfFlightFrame measure_time_of_flight(const RayScene& scene, const PinholeCamera& camera,
                                                       const TimeOfFlightConfig& config, const Pose& T_world_camera,
                                                       DepthImage exact, const DepthImage* before, std::uint64_t frame,
                                                       const Executor& executor);

}  // namespace saccade
