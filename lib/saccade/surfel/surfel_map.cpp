// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/surfel_map.hpp"

#include "saccade/core/result.hpp"

namespace saccade {

Surfel SurfelMap::surfel(SurfelId id) const {
  return {positions_m[id], normals[id], colors[id], radii_m[id], weights[id], color_weights[id]};
}

void SurfelMap::set(SurfelId id, const Surfel& surfel) {
  positions_m[id] = surfel.position_m;
  normals[id] = surfel.normal;
  colors[id] = surfel.color;
  radii_m[id] = surfel.radius_m;
  weights[id] = surfel.weight;
  color_weights[id] = surfel.color_weight;
}

void SurfelMap::resize(std::size_t surfels) {
  SACCADE_EXPECTS(surfels < kNoSurfel);
  positions_m.resize(surfels);
  normals.resize(surfels);
  colors.resize(surfels);
  radii_m.resize(surfels);
  weights.resize(surfels);
  color_weights.resize(surfels);
}

std::size_t SurfelMap::memory_bytes() const {
  return 3 * positions_m.capacity() * sizeof(Eigen::Vector3f) + 3 * radii_m.capacity() * sizeof(float);
}

}  // namespace saccade
