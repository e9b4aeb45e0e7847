// SPDX-License-Identifier: Apache-2.0
#pragma once
// set_brick: writes a brick of a map by hand; written_map: a map whose voxels a function says.

#include <functional>
#include <utility>

#include "saccade/map/tsdf_map.hpp"

namespace saccade::test {

/// Puts a brick in its place, in the one representation that its content has.
inline void set_brick(TsdfSnapshot& map, const Index3& brick, BrickRef content) {
  content.canonicalize(map.config.free_weight);
  Sector& sector = map.grid.writable(parent(brick));
  sector.bricks[static_cast<std::size_t>(child_index(brick))] = std::move(content);
  sector.update_summary(child_index(brick), map.config.free_weight);
}

using StateAt = std::function<VoxelState(const Eigen::Vector3d& p)>;

/// A workspace in voxels of 1 cm, seen five times where it was.
inline TsdfSnapshot written_map(const StateAt& state_at,
                                const Box& workspace = Box{{-0.3, -0.3, -0.1}, {0.3, 0.3, 0.4}}) {
  constexpr double kVoxelEdge_m{0.01};
  TsdfSnapshot map;
  map.config.voxel_size_m = kVoxelEdge_m;
  map.config.workspace = workspace;
  parents(voxels_with_center_in(workspace, kVoxelEdge_m)).for_each([&](const Index3& brick) {
    BrickRef ref;
    DenseBrick& dense = ref.densify();
    IndexBox::cube(brick * kBrickEdge, kBrickEdge).for_each([&](const Index3& voxel) {
      const VoxelState state = state_at(voxel_center(voxel, kVoxelEdge_m));
      const auto i = static_cast<std::size_t>(child_index(voxel));
      dense.w[i] = state == VoxelState::unknown ? 0 : 5;
      dense.v[i] = state == VoxelState::occupied ? -1000 : state == VoxelState::empty ? kTsdfOne : 0;
    });
    dense.update_masks();
    set_brick(map, brick, std::move(ref));
  });
  return map;
}

}  // namespace saccade::test
