// SPDX-License-Identifier: Apache-2.0
#pragma once
// capture_time_of_flight: what a time-of-flight camera such as the Kinect v2 measures of a RayScene, and what is wrong
// with it, pixel by pixel.  Thesis §3.1.3, Figs. 3.10–3.12.

#include <cstdint>

#include "saccade/scene/ray_scene.hpp"
#include "saccade/sensor/kinect_v2_filter.hpp"
#include "saccade/sensor/noise.hpp"

namespace saccade {

struct TimeOfFlightConfig {
  PinholeCamera camera;                         ///< default: that of a Kinect v2
  double baseline_m{0.08};                      ///< from the camera to the emitter, along the camera's x axis
  EmitterSide emitter_side{EmitterSide::left};  ///< as DepthFilterConfig has it
  double shadow_sigma_m{0.1};                   ///< standard deviation of points that the emitter does not light
  double footprint_px{1.0};                     ///< edge of the square that a pixel sees
  int footprint_samples{4};                     ///< rays along each edge of it, where it may hold an edge
  double veil_distance_m{0.03};  ///< a mixed depth farther than this from all that the pixel sees is a veil point
  DepthNoise noise{0.002, 0.0, 0.0, 0.0, 0.0};  ///< of all other points; its seed is that of the shadow points too

  TimeOfFlightConfig();
  /// invalid_argument, as PinholeCamera, DepthFilterConfig and DepthNoise, or for a footprint that is not within 0 and
  /// 5 pixels or not of 2 to 16 samples.
  [[nodiscard]] Status validate() const;
};

/// The truth about a pixel: what DepthFilter should keep, and what it should remove.
enum class MeasuredPixel : std::uint8_t { no_return, good, in_shadow, veil };

struct TimeOfFlightFrame {
  DepthImage depth;            ///< as measured
  DepthImage exact;            ///< along each pixel's central ray
  Image<MeasuredPixel> truth;  ///< all three of one size
};

/// A point that the emitter does not light gets noise of shadow_sigma_m. At edges, a pixel measures the mean over its
/// footprint, weighted by 1/z² as light returns; that is a veil point where it lies farther than veil_distance_m from
/// all that the footprint holds. Everything else is measured with `noise`. The n-th frame of a seed is the same for
/// every thread count. Expects a finite pose. invalid_argument as validate. O(pixels · log triangles).
[[nodiscard]] Result<TimeOfFlightFrame> capture_time_of_flight(const RayScene& scene, const TimeOfFlightConfig& config,
                                                               const Pose& T_world_camera, std::uint64_t frame = 0,
                                                               const Executor& executor = {});

}  // namespace saccade
