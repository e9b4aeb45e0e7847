// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/voxel_set.hpp"

namespace saccade {

VoxelSet::VoxelSet(const IndexBox& voxels)
    : bricks_{parents(voxels)}, masks_(static_cast<std::size_t>(bricks_.count())) {}

void VoxelSet::insert(const Index3& voxel) {
  const Index3 i = parent(voxel) - bricks_.lo;
  const auto size_x = static_cast<std::size_t>(bricks_.hi.x - bricks_.lo.x);
  const auto size_y = static_cast<std::size_t>(bricks_.hi.y - bricks_.lo.y);
  const std::size_t slice = static_cast<std::size_t>(i.z) * size_y + static_cast<std::size_t>(i.y);
  masks_[slice * size_x + static_cast<std::size_t>(i.x)].set(child_index(voxel));
}

std::uint64_t VoxelSet::count() const {
  std::uint64_t n{0};
  for (const Mask512& mask : masks_) n += static_cast<std::uint64_t>(mask.count());
  return n;
}

}  // namespace saccade
