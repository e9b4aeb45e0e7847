// SPDX-License-Identifier: Apache-2.0
#pragma once
// OpenCV's bilateral filter, where it is installed.

#include "thesis/depth_baselines.hpp"

namespace saccade::bench {

#ifdef SACCADE_WITH_OPENCV
[[nodiscard]] DepthImage opencv_bilateral(const DepthImage& depth, const thesis::BilateralConfig& config);
[[nodiscard]] constexpr bool has_opencv() { return true; }
#else
[[nodiscard]] inline DepthImage opencv_bilateral(const DepthImage& depth, const thesis::BilateralConfig&) {
  return depth;
}
[[nodiscard]] constexpr bool has_opencv() { return false; }
#endif

}  // namespace saccade::bench
