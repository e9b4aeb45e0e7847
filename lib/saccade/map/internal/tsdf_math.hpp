// SPDX-License-Identifier: Apache-2.0
#pragma once
// Per-voxel mathematics of fusion, written once: ranges, samples, the running average. Thesis eq. (2.1)–(2.3).
//
// Every operation is a single correctly rounded float or integer operation in a fixed order (no contraction to FMA), so
// that the naive reference, the brick loop and any later back end agree to the bit.

#include <cmath>
#include <cstdint>

#include "saccade/core/host_device.hpp"

namespace saccade::tsdf {

/// A point or direction in camera coordinates, metres.
struct Float3 {
  float x;
  float y;
  float z;
};

/// The camera and the truncation, in the precision of the voxel loop.
struct FusionCamera {
  float fx;
  float fy;
  float cx;
  float cy;
  int width;
  int height;
  float truncation_m;
  float inv_truncation;  ///< 1 / M_v
};

/// Brick in camera coordinates: centre of voxel (0, 0, 0), and one step along each axis.
struct BrickFrame {
  Float3 origin;
  Float3 step_x;
  Float3 step_y;
  Float3 step_z;
};

/// Smallest distance from the camera's plane at which voxels are updated.
constexpr float kNearestZ{1e-3F};
/// A sample of 1: v of voxels farther than the truncation in front of the surface.
constexpr int kSampleOne{32767};
/// Sample of a voxel that was not observed.
constexpr int kNotSeen{-32768};

/// Rounds to the nearest integer, ties to even, for |x| < 2²². Equal on every machine, without touching the rounding
/// mode.
SACCADE_HD inline float round_to_even(float x) {
  constexpr float kMagic{12582912.0F};  // 1.5 · 2²³
  return (x + kMagic) - kMagic;
}

/// Returns ((u − c_x) / f_x)² of a column u, or the equivalent for a row.
SACCADE_HD inline float squared_slope(int pixel, float center, float focal_length) {
  const float slope = (static_cast<float>(pixel) - center) / focal_length;
  return slope * slope;
}

/// Returns ‖p − o‖ of eq. 2.1 for a depth d at pixel (u, v), with the sign of d (d < 0: free up to |d|).
SACCADE_HD inline float range_of_depth(const FusionCamera& camera, int u, int v, float depth_m) {
  const float dx_squared = squared_slope(u, camera.cx, camera.fx);
  const float dy_squared = squared_slope(v, camera.cy, camera.fy);
  return depth_m * std::sqrt((dx_squared + dy_squared) + 1.0F);
}

SACCADE_HD inline Float3 voxel_in_camera(const BrickFrame& frame, int x, int y, int z) {
  const auto fx = static_cast<float>(x);
  const auto fy = static_cast<float>(y);
  const auto fz = static_cast<float>(z);
  return {((frame.origin.x + frame.step_z.x * fz) + frame.step_y.x * fy) + frame.step_x.x * fx,
          ((frame.origin.y + frame.step_z.y * fz) + frame.step_y.y * fy) + frame.step_x.y * fx,
          ((frame.origin.z + frame.step_z.z * fz) + frame.step_y.z * fy) + frame.step_x.z * fx};
}

/// Pixel whose beam holds p. Outside the image, `inside` is false and the pixel is (0, 0). Computed without branches,
/// so that loops become vector code.
struct Pixel {
  int u;
  int v;
  bool inside;
};
SACCADE_HD inline Pixel pixel_of(const FusionCamera& camera, const Float3& p) {
  const float inv_z = 1.0F / p.z;
  const float u = (camera.fx * (p.x * inv_z) + camera.cx) + 0.5F;
  const float v = (camera.fy * (p.y * inv_z) + camera.cy) + 0.5F;
  const bool inside = (p.z > kNearestZ) & (u >= 0.0F) & (v >= 0.0F) & (u < static_cast<float>(camera.width)) &
                      (v < static_cast<float>(camera.height));
  return {static_cast<int>(inside ? u : 0.0F), static_cast<int>(inside ? v : 0.0F), inside};
}

/// Returns the new observation of a voxel at p, given the range seen in its beam (0: none): clamp(v_SDF / M_v) of eq.
/// 2.2 in units of 1/32767, or kNotSeen behind the truncation.
SACCADE_HD inline int sample_voxel(const FusionCamera& camera, const Float3& p, float range_m) {
  const float distance = std::sqrt((p.x * p.x + p.y * p.y) + p.z * p.z);
  const float sdf = range_m - distance;  // eq. 2.1
  const float scaled = sdf * camera.inv_truncation;
  const float below_one = scaled > 1.0F ? 1.0F : scaled;
  const float clamped = below_one < -1.0F ? -1.0F : below_one;
  const int sample = static_cast<int>(round_to_even(clamped * 32767.0F));
  const bool hit = (range_m > 0.0F) & (sdf >= -camera.truncation_m);
  const bool seen_free = (range_m < 0.0F) & (distance <= -range_m);
  return hit ? sample : (seen_free ? kSampleOne : kNotSeen);
}

/// Returns the observation that enters the average. Where a beam sees farther than the truncation past a voxel found
/// near a surface, it moves v towards 1 by only `share` of the distance (docs/decisions/0021).
SACCADE_HD inline int clearing_sample(std::int16_t v, std::uint16_t w, int sample, float share) {
  const int way = static_cast<int>(round_to_even(static_cast<float>(kSampleOne - static_cast<int>(v)) * share));
  return sample == kSampleOne && w > 0 ? static_cast<int>(v) + way : sample;
}

/// Averages v by eq. 2.2 in fixed point. The numerator is exact in float for w ≤ 500.
SACCADE_HD inline std::int16_t average_v(std::int16_t v, std::uint16_t w, int sample) {
  const int numerator = static_cast<int>(v) * static_cast<int>(w) + sample;
  return static_cast<std::int16_t>(round_to_even(static_cast<float>(numerator) / static_cast<float>(w + 1)));
}

/// Returns the next weight by eq. 2.3; where v = 1 it saturates at W_th already (docs/decisions/0001).
SACCADE_HD inline std::uint16_t next_w(std::int16_t new_v, std::uint16_t w, std::uint16_t max_weight,
                                       std::uint16_t free_weight) {
  const std::uint16_t limit = new_v == kSampleOne ? free_weight : max_weight;
  return w + 1 < limit ? static_cast<std::uint16_t>(w + 1) : limit;
}

/// Limit of observations that a colour averages over; more would no longer move 8-bit values.
constexpr int kColorWeight{15};

/// Averages one colour channel; w counts earlier observations.
SACCADE_HD inline std::uint8_t average_color(std::uint8_t old_value, std::uint16_t w, std::uint8_t sample) {
  const int weight = w < kColorWeight ? w : kColorWeight;
  return static_cast<std::uint8_t>((old_value * weight + sample + (weight + 1) / 2) / (weight + 1));
}

}  // namespace saccade::tsdf
