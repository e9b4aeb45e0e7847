// SPDX-License-Identifier: Apache-2.0
#pragma once
// DrawnSurfels: seen and unknown surfels with the colours in which pictures of an exploration show them.

#include <span>
#include <vector>

#include "saccade/core/region.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/surfel/surfel_map.hpp"
#include "saccade/surfel/surfel_points.hpp"

namespace saccade {

/// Discs with a colour each. World frame.
struct DrawnSurfels {
  std::vector<Eigen::Vector3f> positions_m;
  std::vector<Eigen::Vector3f> normals;
  std::vector<float> radii_m;
  std::vector<Rgb8> colors;

  [[nodiscard]] SurfelDiscs discs() const { return {positions_m, normals, radii_m}; }
};

/// Colour of unknown surfels.
constexpr Rgb8 kUnknownColor{232, 152, 56};

/// Returns the discs whose centres lie in a box: seen ones of weight w_s ≥ min_weight in their fused colour, grey
/// without one, and unknown ones in kUnknownColor, both shaded by their normals.
[[nodiscard]] DrawnSurfels drawn_surfels(const SurfelMap& seen, double min_weight, std::span<const SurfelDisc> unknown,
                                         const Box& box);

}  // namespace saccade
