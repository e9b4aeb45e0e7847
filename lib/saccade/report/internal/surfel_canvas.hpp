// SPDX-License-Identifier: Apache-2.0
#pragma once
// draw_surfels_into: surfels as a canvas' viewpoint sees them.

#include <span>

#include "saccade/core/executor.hpp"
#include "saccade/report/internal/canvas.hpp"
#include "saccade/surfel/surfel_points.hpp"

namespace saccade {

/// Draws each disc in its colour into an empty canvas. Expects a colour per disc.
void draw_surfels_into(Canvas& canvas, const SurfelDiscs& discs, std::span<const Rgb8> colors,
                       const Executor& executor);

}  // namespace saccade
