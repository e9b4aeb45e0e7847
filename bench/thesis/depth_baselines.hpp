// SPDX-License-Identifier: Apache-2.0
#pragma once
// The filters that thesis §3.2.3 compares with, on depth alone: the driver's work on what the sensor measures before
// depth is made of it, which no simulation here has.

#include "saccade/sensor/image.hpp"

namespace saccade::thesis {

struct BilateralConfig {
  int radius_px{2};
  double sigma_px{1.5};
  double sigma_m{0.03};
};

/// Bilateral filter (Tomasi and Manduchi 1998) over a round window: the mean of the neighbours, weighted by how near
/// they are in the image and in depth. Pixels without a return are kept and take no part. O(pixels · window).
[[nodiscard]] DepthImage bilateral(const DepthImage& depth, const BilateralConfig& config = {});

struct EdgeAwareConfig {
  double nearer_m{0.05};
  double farther_m{0.03};
  int max_neighbours{5};
};

/// After the driver's filter of this name: a point is removed when more than max_neighbours of its eight neighbours are
/// nearer by nearer_m or farther by farther_m. O(pixels).
[[nodiscard]] DepthImage edge_aware(const DepthImage& depth, const EdgeAwareConfig& config = {});

}  // namespace saccade::thesis
