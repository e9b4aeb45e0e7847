// SPDX-License-Identifier: Apache-2.0
#pragma once
// HostPools: the voxels of bricks on their way to the device.

#include <vector>

#include "saccade/cuda/internal/device_map.hpp"
#include "saccade/map/brick.hpp"

namespace saccade::internal::cuda {

/// Stored bricks on their way to the device.
struct HostPools {
  std::vector<std::int16_t> v;
  std::vector<std::uint16_t> w;
  std::vector<std::uint64_t> unknown;
  std::vector<std::uint64_t> occupied;

  /// Adds a brick, whose entry in the table will name this slot.
  BrickEntry add(const BrickRef& brick, std::uint32_t slot) {
    for (int i = 0; i < kBrickVoxels; ++i) {
      const Voxel voxel = brick.voxel(i);
      v.push_back(voxel.v);
      w.push_back(voxel.w);
    }
    const Mask512 unknown_voxels = brick.unknown_mask();
    const Mask512 occupied_voxels = brick.occupied_mask();
    unknown.insert(unknown.end(), unknown_voxels.words.begin(), unknown_voxels.words.end());
    occupied.insert(occupied.end(), occupied_voxels.words.begin(), occupied_voxels.words.end());
    return BrickEntry::at(slot, (unknown_voxels | occupied_voxels).any(), occupied_voxels.any());
  }
  [[nodiscard]] std::size_t count() const { return unknown.size() / kBrickWords; }
};

}  // namespace saccade::internal::cuda
