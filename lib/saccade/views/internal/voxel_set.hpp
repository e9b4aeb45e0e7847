// SPDX-License-Identifier: Apache-2.0
#pragma once
// VoxelSet: a set of voxels within a box, as masks of bricks.

#include <cstdint>
#include <vector>

#include "saccade/map/brick.hpp"

namespace saccade {

/// A set of voxels within a box.
class VoxelSet {
 public:
  explicit VoxelSet(const IndexBox& voxels);
  void insert(const Index3& voxel);
  [[nodiscard]] std::uint64_t count() const;

 private:
  IndexBox bricks_;
  std::vector<Mask512> masks_;
};

}  // namespace saccade
