// SPDX-License-Identifier: Apache-2.0
#pragma once
// Depth noise for rendered images: axial, growing with the square of the distance; seeded.

#include <cstdint>

#include "saccade/core/angle.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

/// Axial noise of a structured-light camera: σ(z) = base_m + quadratic_per_m · (z − offset_m)², with the values that
/// Nguyen, Izadi and Lovell (3DIMPVT 2012) measured on a Kinect v1. Optionally rounds to disparity steps, and loses
/// pixels at random or on surfaces seen at a grazing angle.
struct DepthNoise {
  double base_m{0.0012};
  double quadratic_per_m{0.0019};
  double offset_m{0.4};
  double disparity_step_per_m{0.0};  ///< depth is rounded to multiples of 1/this in 1/z; 0: not rounded
  double dropout{0.0};               ///< share of the returns that are lost
  double grazing_from_rad{90_deg};   ///< angle of incidence from which returns get lost, all at 90°
  std::uint64_t seed{1};

  /// Answers invalid_argument for negative or infinite parameters, or a dropout above 1.
  [[nodiscard]] Status validate() const;
  /// Returns the standard deviation at depth z.
  [[nodiscard]] double sigma_m(double z_m) const {
    return base_m + quadratic_per_m * (z_m - offset_m) * (z_m - offset_m);
  }
};

/// Returns the image with noise; pixels without a return (≤ 0, NaN) are kept. Each pixel's noise depends only on the
/// seed, the frame number and its index, so the result is equal on every machine, for every order of frames, and for
/// every thread count. Expects valid noise. incidence_cosine: cosine of the angle between each pixel's ray and the
/// surface's normal, an image of equal size. Without it, no grazing returns are lost. O(pixels).
[[nodiscard]] DepthImage with_noise(const DepthImage& depth, const DepthNoise& noise, std::uint64_t frame = 0,
                                    const Image<float>* incidence_cosine = nullptr, const Executor& executor = {});

}  // namespace saccade
