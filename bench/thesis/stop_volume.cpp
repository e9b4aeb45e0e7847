// SPDX-License-Identifier: Apache-2.0
#include "thesis/stop_volume.hpp"

#include <algorithm>
#include <array>

#include "saccade/map/voxels_inside.hpp"

namespace saccade::thesis {

StopVolume::StopVolume(const IndexBox& bricks)
    : box_{bricks.lo * kBrickEdge, bricks.hi * kBrickEdge}, size_{box_.hi - box_.lo} {
  SACCADE_EXPECTS(!bricks.empty());
  stops_.resize(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                static_cast<std::size_t>(size_.z));
}

StopVolume StopVolume::fill(const TsdfSnapshot& map, const Region& region, const IndexBox& bricks,
                            const Executor& executor) {
  StopVolume volume{bricks};
  const auto layers = static_cast<std::size_t>(bricks.hi.z - bricks.lo.z);
  executor.parallel_for(layers, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t layer = begin; layer < end; ++layer) {
      const std::int32_t z = bricks.lo.z + static_cast<std::int32_t>(layer);
      for (std::int32_t y = bricks.lo.y; y < bricks.hi.y; ++y) {
        for (std::int32_t x = bricks.lo.x; x < bricks.hi.x; ++x) volume.fill_brick(map, region, {x, y, z});
      }
    }
  });
  return volume;
}

void StopVolume::fill_brick(const TsdfSnapshot& map, const Region& region, const Index3& brick) {
  const Sector* sector = map.grid.find(parent(brick));
  const BrickRef ref = sector == nullptr ? BrickRef{} : sector->bricks[static_cast<std::size_t>(child_index(brick))];
  const Mask512 unknown = ref.unknown_mask();
  const Mask512 stop = unknown | ref.occupied_mask();
  if (stop.none()) return;
  const Mask512 score = unknown & voxels_inside(region, brick * kBrickEdge, map.config.voxel_size_m);
  const Index3 corner = brick * kBrickEdge - box_.lo;
  for (int row = 0; row < kBrickVoxels; row += kBrickEdge) {
    const auto first = stops_.begin() + static_cast<std::ptrdiff_t>(flat_index(corner + child_offset(row)));
    for (int x = 0; x < kBrickEdge; ++x) {
      if (stop.test(row + x)) first[x] = score.test(row + x) ? Stop::scores : Stop::blocks;
    }
  }
}

bool StopVolume::is_boundary(const Index3& offset) const {
  if (at_offset(offset) == Stop::no) return false;
  constexpr std::array<Index3, 6> kNeighbours{{{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};
  const IndexBox inside{{0, 0, 0}, size_};
  return std::any_of(kNeighbours.begin(), kNeighbours.end(), [&](const Index3& step) {
    return inside.contains(offset + step) && at_offset(offset + step) == Stop::no;
  });
}

std::vector<Index3> StopVolume::boundary() const {
  std::vector<Index3> voxels;
  for (std::int32_t z = 0; z < size_.z; ++z) {
    for (std::int32_t y = 0; y < size_.y; ++y) {
      for (std::int32_t x = 0; x < size_.x; ++x) {
        if (is_boundary({x, y, z})) voxels.push_back(box_.lo + Index3{x, y, z});
      }
    }
  }
  return voxels;
}

}  // namespace saccade::thesis
