// SPDX-License-Identifier: Apache-2.0
#pragma once
// fusion_picture: measured depth, the map's ray cast, and their difference, side by side.

#include <optional>
#include <string>

#include "saccade/report/depth_picture.hpp"

namespace saccade {

struct FusionPictureConfig {
  std::string title{"Depth frame against the map"};
  double limit_m{0.02};             ///< of the difference's colours
  std::optional<DepthScale> scale;  ///< chosen from the measured depth by default
};

/// How well the map explains a frame.
struct Residual {
  double median_m{0.0};  ///< of |ray cast − measured| where both have a return
  double share{0.0};     ///< of the pixels with a measured return, those where the ray cast has one too
};
[[nodiscard]] Residual residual(const DepthImage& measured, const DepthImage& map_cast);

/// A sheet of three panels; the note below says the median residual and its share. Expects equal sizes.
[[nodiscard]] ColorImage fusion_picture(const DepthImage& measured, const DepthImage& map_cast,
                                        const FusionPictureConfig& config = {});

}  // namespace saccade
