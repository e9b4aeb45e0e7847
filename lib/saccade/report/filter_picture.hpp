// SPDX-License-Identifier: Apache-2.0
#pragma once
// filter_picture: a depth image before and after the Kinect v2 filter, and what the filter removed.

#include <string>

#include "saccade/sensor/image.hpp"
#include "saccade/sensor/kinect_v2_filter.hpp"

namespace saccade {

constexpr Rgb8 kShadowPointColor{230, 85, 13};
constexpr Rgb8 kVeilPointColor{49, 130, 189};

/// Three panels: the depth as it came, as it is filtered (one scale for both), and the points that stay in grey,
/// lighter where nearer, with those removed coloured by step. Expects images of one size.
[[nodiscard]] ColorImage filter_picture(const DepthImage& before, const FilteredDepth& filtered,
                                        const std::string& title);

}  // namespace saccade
