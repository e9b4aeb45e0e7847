// SPDX-License-Identifier: Apache-2.0
#pragma once
// Promise: what a view is expected to make known, voxel by voxel, so that it can be checked afterwards.

#include <vector>

#include "saccade/map/tsdf_map.hpp"

namespace saccade {

/// An unknown voxel that a view is expected to make known.
struct PromisedVoxel {
  Index3 voxel{};
  double worth{0.0};  ///< share of the view's gain, in any unit
};

/// Voxels may come more than once.
struct Promise {
  std::vector<PromisedVoxel> voxels{};

  [[nodiscard]] double worth() const;
  /// The share of its worth that the map knows by now: empty or occupied. Expects some worth. O(voxels).
  [[nodiscard]] double kept(const TsdfGrid& map) const;
};

}  // namespace saccade
