// SPDX-License-Identifier: Apache-2.0
#pragma once
// complete_objects: objects that stand on supports, each as far as it may reach; distance_to_objects.

#include <cstdint>
#include <span>
#include <vector>

#include "saccade/views/internal/state_volume.hpp"
#include "saccade/views/supports.hpp"

namespace saccade {

struct CompletedObjects {
  std::size_t count{0};
  std::vector<std::uint32_t> seen;  ///< occupied voxels of all objects
  std::vector<std::uint8_t>
      is_inside;  ///< per voxel of the volume: in the extruded hull of an object, whatever its state
};

/// O(voxels of the volume).
[[nodiscard]] CompletedObjects complete_objects(const StateVolume& volume, std::span<const Support> supports);

/// Distance to the nearest seen voxel of an object, to within a few per cent, for cells of 2³ voxels; infinity beyond
/// `reach_m`.
[[nodiscard]] std::vector<float> distance_to_objects(const StateVolume& volume, const CompletedObjects& objects,
                                                     double reach_m);
/// The cell that a voxel lies in.
[[nodiscard]] inline std::size_t half_resolution_index(const StateVolume& volume, std::size_t voxel) {
  const Index3 at = volume.voxel(voxel) - volume.box().lo;
  const Index3 size = volume.box().size();
  return (static_cast<std::size_t>(at.z / 2) * static_cast<std::size_t>((size.y + 1) / 2) +
          static_cast<std::size_t>(at.y / 2)) *
             static_cast<std::size_t>((size.x + 1) / 2) +
         static_cast<std::size_t>(at.x / 2);
}

}  // namespace saccade
