// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/surfel_points.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/core/result.hpp"

namespace saccade {

std::vector<SurfelId> shown_surfels(const SurfelMap& map, double min_weight) {
  std::vector<SurfelId> shown;
  std::vector<SurfelId> colored;
  for (SurfelId id = 0; id < map.size(); ++id) {
    if (static_cast<double>(map.discs[id].weight) < min_weight) continue;
    shown.push_back(id);
    if (map.colors[id].weight > 0.0F) colored.push_back(id);
  }
  return colored.empty() ? shown : colored;
}

SurfelPoints surfel_points(const SurfelMap& map, std::span<const SurfelMode> modes, double min_weight) {
  SACCADE_EXPECTS(modes.empty() || modes.size() == map.size());
  SurfelPoints points;
  for (const SurfelId id : shown_surfels(map, min_weight)) {
    const Surfel surfel = map.surfel(id);
    const bool has_mode = !modes.empty() && modes[id].weight > 0.0F;
    points.positions_m.push_back(has_mode ? modes[id].position_m : surfel.disc.position_m);
    points.colors.push_back(has_mode ? modes[id].color : surfel.color.color);
    points.normals.push_back(surfel.disc.normal);
    points.radii_m.push_back(surfel.disc.radius_m);
    points.weights.push_back(surfel.disc.weight);
    points.has_color = points.has_color || surfel.color.weight > 0.0F;
  }
  return points;
}

void put_at_averages(std::span<SurfelMode> modes, const SurfelMap& map) {
  SACCADE_EXPECTS(modes.size() == map.size());
  for (SurfelId id = 0; id < map.size(); ++id) modes[id].position_m = map.discs[id].position_m;
}

Rgb8 byte_color(const Eigen::Vector3f& color) {
  const auto level = [](float value) {
    return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F)));
  };
  return {level(color.x()), level(color.y()), level(color.z())};
}

}  // namespace saccade
