// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/rendered_sequence.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace saccade {
namespace {

constexpr std::size_t kRowsAtOnce{8};

/// Counter-based generator, as for the depth noise.
std::uint64_t scrambled(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31U);
}

/// Returns a number with mean 0 and variance 1 from four uniform numbers of 16 bits; its absolute value stays below
/// 3.5.
double nearly_normal(std::uint64_t key) {
  const std::uint64_t bits = scrambled(key);
  double sum = 0.0;
  for (unsigned shift = 0; shift < 64; shift += 16) sum += static_cast<double>((bits >> shift) & 0xFFFFU) + 0.5;
  return (sum / 65536.0 - 2.0) * 1.7320508075688772;  // √(12/4)
}

/// Look-up of the nearest of the 256 codes for a linear value within 0 and 1, by the start of its neighbourhood.
class SrgbCodes {
 public:
  SrgbCodes() {
    for (std::size_t code = 0; code < 256; ++code) {
      from_[code] = code == 0 ? 0.0 : linear_of_srgb((static_cast<double>(code) - 0.5) / 255.0);
    }
    from_[256] = 2.0;
    std::size_t code = 0;
    for (std::size_t i = 0; i < start_.size(); ++i) {
      while (from_[code + 1] <= static_cast<double>(i) / kCells) ++code;
      start_[i] = static_cast<std::uint8_t>(code);
    }
  }
  [[nodiscard]] std::uint8_t of(double linear) const {
    std::size_t code = start_[static_cast<std::size_t>(linear * kCells)];
    while (from_[code + 1] <= linear) ++code;
    return static_cast<std::uint8_t>(code);
  }

 private:
  static constexpr double kCells{1024.0};
  std::array<double, 257> from_{};
  std::array<std::uint8_t, 1025> start_{};
};

}  // namespace

Status ColorCameraConfig::validate() const {
  for (const double value : {electrons_at_white, target_light, time_constant_frames}) {
    if (std::isfinite(value) && value > 0.0) continue;
    return Error{Errc::invalid_argument, "electrons, target and time constant must be positive", "colour camera"};
  }
  if (!(std::isfinite(read_noise_electrons) && read_noise_electrons >= 0.0)) {
    return Error{Errc::invalid_argument, "the read noise must not be negative", "colour camera"};
  }
  if (!(std::isfinite(max_gain) && max_gain >= 1.0)) {
    return Error{Errc::invalid_argument, "the largest gain must be 1 at least", "colour camera"};
  }
  return {};
}

double vignetting_at(const PinholeCamera& camera, double u, double v) {
  const double cosine_squared = 1.0 / camera.ray(u, v).squaredNorm();
  return cosine_squared * cosine_squared;
}

double next_gain(const ColorCameraConfig& config, double gain, double mean_light) {
  if (!config.automatic_gain) return 1.0;
  if (!(mean_light > 0.0)) return gain;
  const double wanted = std::clamp(config.target_light / mean_light, 1.0 / config.max_gain, config.max_gain);
  return gain * std::pow(wanted / gain, 1.0 - std::exp(-1.0 / config.time_constant_frames));
}

double mean_light(const LightImage& light, const PinholeCamera& camera, const ColorCameraConfig& config) {
  SACCADE_EXPECTS(light.width() == camera.width && light.height() == camera.height && !light.empty());
  double sum = 0.0;
  for (int v = 0; v < light.height(); ++v) {
    for (int u = 0; u < light.width(); ++u) {
      const double share = config.vignetting == Vignetting::off ? 1.0 : vignetting_at(camera, u, v);
      for (const float channel : light(u, v)) sum += share * channel;
    }
  }
  return sum / (3.0 * static_cast<double>(light.size()));
}

ColorImage expose(const LightImage& light, const PinholeCamera& camera, const ColorCameraConfig& config, double gain,
                  std::uint64_t frame, const Executor& executor) {
  SACCADE_EXPECTS(config.validate().ok());
  SACCADE_EXPECTS(light.width() == camera.width && light.height() == camera.height);
  static const SrgbCodes codes;
  ColorImage image{light.width(), light.height()};
  const std::uint64_t frame_key = scrambled(scrambled(config.seed ^ 0xC0104ULL) ^ frame);
  const double read_variance = config.read_noise_electrons * config.read_noise_electrons;
  const auto pixel = [&](int u, int v) {
    const double share = config.vignetting == Vignetting::off ? 1.0 : vignetting_at(camera, u, v);
    const auto index =
        static_cast<std::uint64_t>(v) * static_cast<std::uint64_t>(light.width()) + static_cast<std::uint64_t>(u);
    for (std::size_t k = 0; k < 3; ++k) {
      double value = share * light(u, v)[k];
      if (config.noise) {
        const double sigma = std::sqrt(value * config.electrons_at_white + read_variance) / config.electrons_at_white;
        value += sigma * nearly_normal(frame_key + 3U * index + k);
      }
      value = std::clamp(value * gain, 0.0, 1.0);  // the sensor saturates before any correction
      if (config.vignetting == Vignetting::corrected) value = std::min(1.0, value / share);
      image(u, v)[k] = codes.of(value);
    }
  };
  executor.parallel_for(static_cast<std::size_t>(light.height()), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      for (int u = 0; u < light.width(); ++u) pixel(u, v);
    }
  });
  return image;
}

}  // namespace saccade
