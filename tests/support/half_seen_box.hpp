// SPDX-License-Identifier: Apache-2.0
#pragma once
// half_seen_box: a map, written by hand, of a box on a table whose top and one side were seen.

#include <cmath>
#include <functional>

#include "support/written_map.hpp"

namespace saccade::test {

using StateAt = std::function<VoxelState(const Eigen::Vector3d& p)>;

/// A workspace of 0.6 m × 0.6 m in voxels of 1 cm, from 0.1 m below a table to 0.4 m above.
inline TsdfSnapshot written_map(const StateAt& state_at) {
  constexpr double kEdge_m{0.01};
  TsdfSnapshot map;
  map.config.voxel_size_m = kEdge_m;
  map.config.workspace = Box{{-0.3, -0.3, -0.1}, {0.3, 0.3, 0.4}};
  parents(voxels_with_center_in(*map.config.workspace, kEdge_m)).for_each([&](const Index3& brick) {
    BrickRef ref;
    DenseBrick& dense = ref.densify();
    IndexBox::cube(brick * kBrickEdge, kBrickEdge).for_each([&](const Index3& voxel) {
      const VoxelState state = state_at(voxel_center(voxel, kEdge_m));
      const auto i = static_cast<std::size_t>(child_index(voxel));
      dense.w[i] = state == VoxelState::unknown ? 0 : 5;
      dense.v[i] = state == VoxelState::occupied ? -1000 : state == VoxelState::empty ? kTsdfOne : 0;
    });
    dense.update_masks();
    set_brick(map, brick, std::move(ref));
  });
  return map;
}

/// The table's top is at z = 0, its inside unknown. The box is 10 cm long in each direction, its side towards +x seen.
inline VoxelState half_seen_box_at(const Eigen::Vector3d& p) {
  const bool inside = std::abs(p.x()) < 0.05 && std::abs(p.y()) < 0.05 && p.z() > 0.0 && p.z() < 0.1;
  if (inside) return p.z() > 0.09 || p.x() > 0.04 ? VoxelState::occupied : VoxelState::unknown;
  if (p.z() > 0.0) return VoxelState::empty;
  return p.z() > -0.02 ? VoxelState::occupied : VoxelState::unknown;
}

inline TsdfSnapshot half_seen_box() { return written_map(half_seen_box_at); }

}  // namespace saccade::test
