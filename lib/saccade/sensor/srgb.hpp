// SPDX-License-Identifier: Apache-2.0
#pragma once
// sRGB (IEC 61966-2-1): conversion between encoded values and linear light, both 0 to 1.

#include <cmath>

namespace saccade {

/// Above the toe, a value is kSrgbScale · light^(1 / kSrgbExponent) − kSrgbOffset.
inline constexpr double kSrgbScale{1.055};
inline constexpr double kSrgbOffset{0.055};
inline constexpr double kSrgbExponent{2.4};

[[nodiscard]] inline double linear_of_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + kSrgbOffset) / kSrgbScale, kSrgbExponent);
}

[[nodiscard]] inline double srgb_of_linear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : kSrgbScale * std::pow(linear, 1.0 / kSrgbExponent) - kSrgbOffset;
}

}  // namespace saccade
