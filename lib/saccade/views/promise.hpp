// SPDX-License-Identifier: Apache-2.0
#pragma once
// Promise: voxels that a view is expected to make known, so that the result can be checked.

#include <vector>

#include "saccade/map/tsdf_map.hpp"

namespace saccade {

/// Unknown voxel that a view is expected to make known.
struct PromisedVoxel {
  Index3 voxel{};
  double worth{0.0};  ///< share of the view's gain, in any unit
};

/// Promise of a view. Voxels may occur more than once.
struct Promise {
  std::vector<PromisedVoxel> voxels{};

  [[nodiscard]] double worth() const;
  /// Returns the share of its worth that the map knows by now: empty or occupied. Expects a positive worth. O(voxels).
  [[nodiscard]] double kept_share(const TsdfGrid& map) const;
};

}  // namespace saccade
