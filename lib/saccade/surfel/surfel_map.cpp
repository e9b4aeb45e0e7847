// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/surfel_map.hpp"

#include "saccade/core/result.hpp"

namespace saccade {

void SurfelMap::resize(std::size_t surfels) {
  SACCADE_EXPECTS(surfels < kNoSurfel);
  if (surfels > discs.capacity()) {  // grows by a sixteenth, since there may be millions
    discs.reserve(surfels + surfels / 16);
    colors.reserve(surfels + surfels / 16);
  }
  discs.resize(surfels);
  colors.resize(surfels);
}

std::size_t SurfelMap::memory_bytes() const {
  return discs.capacity() * sizeof(SurfelDisc) + colors.capacity() * sizeof(SurfelColor);
}

}  // namespace saccade
