// SPDX-License-Identifier: Apache-2.0
#include "thesis/depth_baselines.hpp"

#include <algorithm>
#include <cmath>

namespace saccade::thesis {
namespace {

/// Calls visit(du, dv, z) for the returns of a square around (u, v), it among them.
template <typename Visit>
void visit_around(const DepthImage& depth, int u, int v, int radius_px, const Visit& visit) {
  for (int j = std::max(0, v - radius_px); j <= std::min(depth.height() - 1, v + radius_px); ++j) {
    for (int i = std::max(0, u - radius_px); i <= std::min(depth.width() - 1, u + radius_px); ++i) {
      if (depth(i, j) > 0.0F) visit(i - u, j - v, static_cast<double>(depth(i, j)));
    }
  }
}

double mean_around(const DepthImage& depth, int u, int v, const BilateralConfig& config) {
  const double z = depth(u, v);
  double sum{0.0};
  double weights{0.0};
  visit_around(depth, u, v, config.radius_px, [&](int du, int dv, double at) {
    const double distance2 = du * du + dv * dv;
    if (distance2 > config.radius_px * config.radius_px) return;
    const double off = (at - z) / config.sigma_m;
    const double weight = std::exp(-0.5 * (distance2 / (config.sigma_px * config.sigma_px) + off * off));
    sum += weight * at;
    weights += weight;
  });
  return sum / weights;
}

}  // namespace

DepthImage bilateral(const DepthImage& depth, const BilateralConfig& config) {
  DepthImage filtered = depth;
  for (int v = 0; v < depth.height(); ++v) {
    for (int u = 0; u < depth.width(); ++u) {
      if (depth(u, v) > 0.0F) filtered(u, v) = static_cast<float>(mean_around(depth, u, v, config));
    }
  }
  return filtered;
}

DepthImage edge_aware(const DepthImage& depth, const EdgeAwareConfig& config) {
  DepthImage filtered = depth;
  for (int v = 0; v < depth.height(); ++v) {
    for (int u = 0; u < depth.width(); ++u) {
      const double z = depth(u, v);
      int others{0};
      visit_around(depth, u, v, 1, [&](int, int, double at) {
        others += z - at > config.nearer_m || at - z > config.farther_m ? 1 : 0;
      });
      if (others > config.max_neighbours) filtered(u, v) = 0.0F;
    }
  }
  return filtered;
}

}  // namespace saccade::thesis
