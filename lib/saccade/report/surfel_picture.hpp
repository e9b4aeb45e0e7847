// SPDX-License-Identifier: Apache-2.0
#pragma once
// draw_surfels: surfels as the oriented discs that they are.

#include <span>

#include "saccade/core/executor.hpp"
#include "saccade/report/viewpoint.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/surfel/surfel_points.hpp"

namespace saccade {

struct SurfelPictureConfig {
  int samples{2};  ///< per pixel and direction
  Rgb8 background{24, 26, 30};
};

/// Each disc in its colour, without shading: fused colours carry their own light. What is seen is what view_surfels
/// says. Expects a colour per disc. The thread count does not change the picture.
[[nodiscard]] ColorImage draw_surfels(const SurfelDiscs& discs, std::span<const Rgb8> colors, const Viewpoint& view,
                                      const Executor& executor, const SurfelPictureConfig& config = {});
/// In their own colours.
[[nodiscard]] ColorImage draw_surfels(const SurfelPoints& points, const Viewpoint& view, const Executor& executor,
                                      const SurfelPictureConfig& config = {});

}  // namespace saccade
