// SPDX-License-Identifier: Apache-2.0
#pragma once
// ColorCamera: what a colour camera makes of the light of a scene: vignetting and its correction, automatic gain,
// noise.

#include <array>
#include <cstdint>

#include "saccade/core/executor.hpp"
#include "saccade/core/names.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"
#include "saccade/sensor/srgb.hpp"

namespace saccade {

/// Linear light, 1: white.
using LightImage = Image<std::array<float, 3>>;

enum class Vignetting : std::uint8_t { off, on, corrected };
inline constexpr auto kVignettingNames =
    make_names<Vignetting>({{Vignetting::on, "on"}, {Vignetting::off, "off"}, {Vignetting::corrected, "corrected"}});

struct ColorCameraConfig {
  /// on: light falls off with the fourth power of the cosine of the angle from the axis, to 0.45 in the corners of an
  /// Xtion; Alexandrov et al. (IROS 2016) measured half. corrected: divided by the same again after the noise, as they
  /// do with a calibration, which is taken as exact.
  Vignetting vignetting{Vignetting::on};
  /// Poissonian and Gaussian noise (Foi et al., IEEE TIP 2008) of so many electrons at white, and to read out.
  bool noise{true};
  double electrons_at_white{4000.0};
  double read_noise_electrons{10.0};
  /// The gain follows the image's mean light: it moves towards the target with a time constant, within its limits.
  bool automatic_gain{false};
  double target_light{0.25};
  double time_constant_frames{15.0};
  double max_gain{2.0};  ///< and 1/max_gain at the lower end
  std::uint64_t seed{1};

  /// invalid_argument for numbers that are not positive, and a largest gain below 1.
  [[nodiscard]] Status validate() const;
};

/// Share of the light that reaches an image point.
[[nodiscard]] double vignetting_at(const PinholeCamera& camera, double u, double v);

/// The gain of the frame after one that was taken with `gain`: mean_light is that of the light before any gain.
[[nodiscard]] double next_gain(const ColorCameraConfig& config, double gain, double mean_light);
/// Mean over pixels and channels of light that arrives at the sensor. Expects an image of the camera's size.
[[nodiscard]] double mean_light(const LightImage& light, const PinholeCamera& camera, const ColorCameraConfig& config);

/// 8-bit sRGB. Noise depends on seed, frame and pixel alone. Expects a valid configuration and an image of the camera's
/// size. O(pixels).
[[nodiscard]] ColorImage expose(const LightImage& light, const PinholeCamera& camera, const ColorCameraConfig& config,
                                double gain, std::uint64_t frame, const Executor& executor = {});

}  // namespace saccade
