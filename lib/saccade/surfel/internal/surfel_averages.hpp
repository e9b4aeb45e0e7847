// SPDX-License-Identifier: Apache-2.0
#pragma once
// average_pixels: adds pixels of a frame to the averages of the surfels that they saw. Thesis §4.1.1, eq. 4.1. For
// surfel_fusion.cpp.

#include <span>

#include "saccade/sensor/image.hpp"
#include "saccade/sensor/point_image.hpp"
#include "saccade/surfel/surfel_association.hpp"
#include "saccade/surfel/surfel_map.hpp"

namespace saccade {

/// Observations to average.
struct ObservedFrame {
  const SurfelAssociation& seen;
  const PointImage& points;
  const ColorImage* color;  ///< or nullptr
  float max_radius_m;
  float least_slope;  ///< least cosine between normal and axis; a flatter surface's radii grow no further
};

/// Averages position, normal, radius and colour with weights; surfels from seen.first_new on begin with their pixel.
/// Expects no surfel twice. simd_target() changes nothing.
void average_pixels(const ObservedFrame& frame, std::span<const SurfelPixel> pixels, SurfelMap& map);

}  // namespace saccade
