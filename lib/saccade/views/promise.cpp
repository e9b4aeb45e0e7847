// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/promise.hpp"

#include "saccade/core/result.hpp"

namespace saccade {

double Promise::worth() const {
  double sum{0.0};
  for (const PromisedVoxel& promised : voxels) sum += promised.worth;
  return sum;
}

double Promise::kept_share(const TsdfGrid& map) const {
  const double promised = worth();
  SACCADE_EXPECTS(promised > 0.0);
  double known{0.0};
  for (const PromisedVoxel& voxel : voxels) {
    if (map.state(voxel.voxel) != VoxelState::unknown) known += voxel.worth;
  }
  return known / promised;
}

}  // namespace saccade
