// SPDX-License-Identifier: Apache-2.0
#pragma once
// blend, scaled: arithmetic on 8-bit colours.

#include <algorithm>
#include <cmath>

#include "saccade/sensor/image.hpp"

namespace saccade {

/// `over` laid on `under` with an opacity in [0, 1].
[[nodiscard]] inline Rgb8 blend(const Rgb8& under, const Rgb8& over, double opacity) {
  Rgb8 mixed{};
  for (std::size_t c = 0; c < 3; ++c) {
    mixed[c] = static_cast<std::uint8_t>(std::lround(under[c] + (over[c] - under[c]) * opacity));
  }
  return mixed;
}

/// Brighter or darker, cut at 255.
[[nodiscard]] inline Rgb8 scaled(const Rgb8& color, double factor) {
  Rgb8 out{};
  for (std::size_t c = 0; c < 3; ++c) {
    out[c] = static_cast<std::uint8_t>(std::lround(std::clamp(color[c] * factor, 0.0, 255.0)));
  }
  return out;
}

}  // namespace saccade
