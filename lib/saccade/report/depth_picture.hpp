// SPDX-License-Identifier: Apache-2.0
#pragma once
// Depth images in colours, with what the colours mean; side by side with the map's ray cast, and before and after the
// Kinect v2 filter.

#include <optional>
#include <string>

#include "saccade/report/sheet.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/kinect_v2_filter.hpp"

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

/// Return the two pictures above as panels of a sheet, with their legends.
[[nodiscard]] Panel depth_panel(const DepthImage& depth, const DepthScale& scale, std::string title);
[[nodiscard]] Panel difference_panel(const DepthImage& a, const DepthImage& b, double limit_m, std::string title);

struct FusionPictureConfig {
  std::string title{"Depth frame against the map"};
  double limit_m{0.02};             ///< difference at which the colours end
  std::optional<DepthScale> scale;  ///< chosen from the measured depth by default
};

/// How well the map explains a frame.
struct Residual {
  double median_m{0.0};  ///< median of |ray cast − measured| over the pixels where both have a return
  double share{0.0};     ///< share of the pixels with a measured return in which the ray cast has one too
};
[[nodiscard]] Residual residual(const DepthImage& measured, const DepthImage& map_cast);

/// A sheet of three panels; the note below says the median residual and its share. Expects equal sizes.
[[nodiscard]] ColorImage fusion_picture(const DepthImage& measured, const DepthImage& map_cast,
                                        const FusionPictureConfig& config = {});

constexpr Rgb8 kShadowPointColor{230, 85, 13};
constexpr Rgb8 kVeilPointColor{49, 130, 189};

/// Three panels: the depth as it came, as it is filtered (one scale for both), and the points that stay in grey,
/// lighter where nearer, with those removed coloured by step. Expects images of one size.
[[nodiscard]] ColorImage filter_picture(const DepthImage& before, const FilteredDepth& filtered,
                                        const std::string& title);

}  // namespace saccade
