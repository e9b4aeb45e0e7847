// SPDX-License-Identifier: Apache-2.0
#include "saccade/sensor/noise.hpp"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

/// Counter-based generator (the finaliser of SplitMix64): the n-th number needs no state.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31U);
}

/// Uniform in [0, 1).
double unit(std::uint64_t bits) { return static_cast<double>(bits >> 11U) * 0x1.0p-53; }

/// Returns a roughly normal number with mean 0 and variance 1: the sum of twelve uniform numbers, which never exceeds
/// 6. It needs no transcendental function, whose last bit differs between C libraries.
double normal(std::uint64_t key) {
  double sum = 0.0;
  for (std::uint64_t i = 0; i < 12; ++i) sum += unit(mixed(key + i));
  return sum - 6.0;
}

/// Returns the share of lost returns at an angle of incidence: 0 up to grazing_from_rad, then linear up to 1 at 90°.
/// @param grazing_cosine  of grazing_from_rad
double lost_share(const DepthNoise& noise, double grazing_cosine, double incidence_cosine) {
  constexpr double kRounding{1e-9};
  if (incidence_cosine > grazing_cosine + kRounding) return 0.0;  // spares most pixels the arc cosine
  const double angle_rad = std::acos(std::clamp(incidence_cosine, 0.0, 1.0));
  const double span_rad = 90_deg - noise.grazing_from_rad;
  return span_rad > 0.0 ? std::max(0.0, (angle_rad - noise.grazing_from_rad) / span_rad) : 0.0;
}

}  // namespace

Status DepthNoise::validate() const {
  for (const double value : {base_m, quadratic_per_m, offset_m, disparity_step_per_m, dropout}) {
    if (!std::isfinite(value) || value < 0.0) {
      return Error{Errc::invalid_argument, "its parameters must be finite and not negative", "depth noise"};
    }
  }
  if (!(grazing_from_rad >= 0.0 && grazing_from_rad <= 90_deg)) {
    return Error{Errc::invalid_argument, "the grazing angle is within 0 and 90 degrees", "depth noise"};
  }
  if (dropout > 1.0) return Error{Errc::invalid_argument, "the dropout is a share, at most 1", "depth noise"};
  return {};
}

DepthImage with_noise(const DepthImage& depth, const DepthNoise& noise, std::uint64_t frame,
                      const Image<float>* incidence_cosine, const Executor& executor) {
  SACCADE_EXPECTS(noise.validate().ok());
  SACCADE_EXPECTS(incidence_cosine == nullptr || incidence_cosine->size() == depth.size());
  constexpr std::uint64_t kNumbersPerPixel{16};
  DepthImage noisy = depth;
  const double grazing_cosine = std::cos(noise.grazing_from_rad);
  const std::uint64_t frame_key = mixed(mixed(noise.seed) ^ frame);
  constexpr std::size_t kPixelsPerTask{8192};
  executor.parallel_for(noisy.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double z = noisy.data()[i];
      if (!(z > 0.0)) continue;
      const std::uint64_t key = frame_key + kNumbersPerPixel * i;
      double measured = z + noise.sigma_m(z) * normal(key);
      if (noise.disparity_step_per_m > 0.0) {
        const double steps = std::nearbyint(noise.disparity_step_per_m / measured);
        measured = steps > 0.0 ? noise.disparity_step_per_m / steps : 0.0;
      }
      bool lost = unit(mixed(key + 12)) < noise.dropout || !(measured > 0.0);
      if (incidence_cosine != nullptr) {
        lost = lost || unit(mixed(key + 13)) < lost_share(noise, grazing_cosine, incidence_cosine->data()[i]);
      }
      noisy.data()[i] = lost ? 0.0F : static_cast<float>(measured);
    }
  });
  return noisy;
}

}  // namespace saccade
