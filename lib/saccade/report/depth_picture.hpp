// SPDX-License-Identifier: Apache-2.0
#pragma once
// depth_picture, difference_picture: depth images in colours, with what the colours mean.

#include "saccade/report/sheet.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

/// The depths that the colours span.
struct DepthScale {
  double near_m{0.5};
  double far_m{4.0};
};

/// Colour of pixels without a return.
inline constexpr Rgb8 kNoReturn{34, 36, 42};

/// A round scale around the 1st to 99th percentile of the valid depths of the image; the default where there is none.
[[nodiscard]] DepthScale depth_scale(const DepthImage& depth);

/// Depth in the colours of depth_colors(); pixels without a return (0, NaN, d < 0) are dark.
[[nodiscard]] ColorImage depth_picture(const DepthImage& depth, const DepthScale& scale);

/// a − b: blue below zero, white at zero, red above, saturated at ±limit_m; dark where either has no return.
/// Expects equal sizes.
[[nodiscard]] ColorImage difference_picture(const DepthImage& a, const DepthImage& b, double limit_m);

/// The same as panels of a sheet, with their legends.
[[nodiscard]] Panel depth_panel(const DepthImage& depth, const DepthScale& scale, std::string title);
[[nodiscard]] Panel difference_panel(const DepthImage& a, const DepthImage& b, double limit_m, std::string title);

}  // namespace saccade
