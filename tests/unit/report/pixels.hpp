// SPDX-License-Identifier: Apache-2.0
#pragma once
// What tests of pictures ask of pixels.

#include <algorithm>
#include <cstddef>

#include "saccade/core/executor.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade::test {

inline const Executor kSequential;

inline bool is_dark(const Rgb8& c) { return *std::max_element(c.begin(), c.end()) < 60; }

template <class Predicate>
std::size_t count(const ColorImage& image, const Predicate& predicate) {
  return static_cast<std::size_t>(std::count_if(image.pixels().begin(), image.pixels().end(), predicate));
}
inline std::size_t count(const ColorImage& image, const Rgb8& color) {
  return static_cast<std::size_t>(std::count(image.pixels().begin(), image.pixels().end(), color));
}

}  // namespace saccade::test
