// SPDX-License-Identifier: Apache-2.0
#pragma once
// Checks of pixels for tests of pictures.

#include <algorithm>
#include <cstddef>

#include "saccade/core/executor.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade::test {

inline const Executor kSequential;

inline bool is_dark(const Rgb8& c) { return *std::max_element(c.begin(), c.end()) < 60; }
/// The veil over what is unknown: bluish, whatever grey is behind it.
inline bool is_unknown(const Rgb8& c) { return c[2] - c[0] > 13 && c[2] - c[0] < 40 && c[2] < 200; }

template <class Predicate>
std::size_t count(const ColorImage& image, const Predicate& predicate) {
  return static_cast<std::size_t>(std::count_if(image.pixels().begin(), image.pixels().end(), predicate));
}
inline std::size_t count(const ColorImage& image, const Rgb8& color) {
  return static_cast<std::size_t>(std::count(image.pixels().begin(), image.pixels().end(), color));
}

}  // namespace saccade::test
