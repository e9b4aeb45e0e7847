// SPDX-License-Identifier: Apache-2.0
#pragma once
// DepthEncoding: what the 16-bit samples of a depth image mean, and how they become metres.

#include <cmath>
#include <cstdint>

#include "saccade/core/result.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

/// depth = sample / units_per_m. Samples 0 and 65535 are "no return" in every encoding in use.
///
/// | data                                   | units_per_m | bit_rotated |
/// |----------------------------------------|-------------|-------------|
/// | Kinect, RealSense, 7-Scenes (mm)       | 1000        | no          |
/// | TUM RGB-D                              | 5000        | no          |
/// | Princeton APC / RGB-D SLAM of 0.1 mm   | 10000       | yes         |
///
/// Bit-rotated: the sample was rotated left by three bits before it was stored; it is (v >> 3) | (v << 13).
struct DepthEncoding {
  double units_per_m{1000.0};
  bool bit_rotated{false};

  [[nodiscard]] Status validate() const {
    if (std::isfinite(units_per_m) && units_per_m > 0.0) return {};
    return Error{Errc::invalid_argument, "the depth scale (units per metre) must be positive", {}};
  }
  [[nodiscard]] bool operator==(const DepthEncoding&) const = default;
};

/// Metres along z; 0 where the sample is none. Expects a valid encoding. O(pixels).
[[nodiscard]] inline DepthImage decode_depth(const Image16& samples, const DepthEncoding& encoding) {
  SACCADE_EXPECTS(encoding.validate().ok());
  constexpr std::uint16_t kSaturated{65535};
  const auto units_per_m = static_cast<float>(encoding.units_per_m);
  DepthImage depth{samples.width(), samples.height()};
  const std::uint16_t* in = samples.data();
  float* out = depth.data();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const unsigned stored = in[i];
    const auto sample = static_cast<std::uint16_t>(encoding.bit_rotated ? (stored >> 3U) | (stored << 13U) : stored);
    out[i] = sample == kSaturated ? 0.0F : static_cast<float>(sample) / units_per_m;
  }
  return depth;
}

/// The inverse, rounded to the nearest sample; no return, free claims and depths that do not fit become 0.
[[nodiscard]] inline Image16 encode_depth(const DepthImage& depth, const DepthEncoding& encoding) {
  SACCADE_EXPECTS(encoding.validate().ok());
  Image16 samples{depth.width(), depth.height()};
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const double value = std::round(static_cast<double>(depth.data()[i]) * encoding.units_per_m);
    const unsigned sample = value >= 1.0 && value < 65535.0 ? static_cast<unsigned>(value) : 0U;
    samples.data()[i] = static_cast<std::uint16_t>(encoding.bit_rotated ? (sample << 3U) | (sample >> 13U) : sample);
  }
  return samples;
}

}  // namespace saccade
