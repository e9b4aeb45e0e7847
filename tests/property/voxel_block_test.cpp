// SPDX-License-Identifier: Apache-2.0
// VoxelBlock on random maps: every value is the voxel's, whole and in boxes.
#include <gtest/gtest.h>

#include <iostream>
#include <vector>

#include "saccade/map/voxel_block.hpp"
#include "support/effort.hpp"
#include "support/random_map.hpp"

namespace saccade {
namespace {

constexpr IndexBox kWhole{{-1, -1, -1}, {VoxelBlock::kEdge - 1, VoxelBlock::kEdge - 1, VoxelBlock::kEdge - 1}};

/// The voxels of a box that differ from the map; counts those that are known and those that are not.
struct Compared {
  std::size_t wrong{0};
  std::size_t known{0};
  std::size_t unknown{0};
};
void compare(const VoxelBlock& block, const TsdfGrid& grid, const Index3& brick, std::uint16_t min_weight,
             const IndexBox& box, Compared& compared) {
  for (int z = box.lo.z; z < box.hi.z; ++z) {
    for (int y = box.lo.y; y < box.hi.y; ++y) {
      for (int x = box.lo.x; x < box.hi.x; ++x) {
        const Voxel voxel = grid.voxel(brick * kBrickEdge + Index3{x, y, z});
        const bool known = voxel.w >= min_weight;
        if (block.v({x, y, z}) != (known ? voxel.v : VoxelBlock::kUnknown)) ++compared.wrong;
        ++(known ? compared.known : compared.unknown);
      }
    }
  }
}

/// Bricks that hold something known, or one that does not where there are none.
std::vector<Index3> known_bricks(const TsdfGrid& grid) {
  std::vector<Index3> bricks;
  for (const Index3& at : grid.sorted_sectors()) {
    const Sector& sector = *grid.find(at);
    for (int i = 0; i < kSectorBricks; ++i) {
      if (!sector.bricks[static_cast<std::size_t>(i)].is_unknown())
        bricks.push_back(at * kSectorEdge + child_offset(i));
    }
  }
  if (bricks.empty()) bricks.push_back({0, 0, 0});
  return bricks;
}

TEST(VoxelBlock, HoldsTheVoxelsOfTheMap) {
  const int seeds = test::scaled_cases(60);
  Compared whole;
  Compared boxes;
  for (int seed = 1; seed <= seeds; ++seed) {
    test::RandomMap map{static_cast<std::uint32_t>(seed)};
    for (int step = 0; step < 3; ++step) map.step();
    const TsdfSnapshot snapshot = map.snapshot();
    const SectorTable table{snapshot.grid};
    test::RandomRun& run = map.run();
    const std::vector<Index3> known = known_bricks(snapshot.grid);
    VoxelBlock block;
    for (int i = 0; i < 40; ++i) {
      const Index3 beside{run.integer(-1, 1), run.integer(-1, 1), run.integer(-1, 1)};
      const Index3 brick = known[static_cast<std::size_t>(run.integer(0, static_cast<int>(known.size()) - 1))] + beside;
      const auto min_weight = static_cast<std::uint16_t>(run.integer(1, 6));
      if (i % 2 == 0) {
        block.load(table, brick, min_weight);
        compare(block, snapshot.grid, brick, min_weight, kWhole, whole);
      } else {  // over what another brick left
        const Index3 lo{run.integer(-1, 8), run.integer(-1, 8), run.integer(-1, 8)};
        const Index3 hi{run.integer(lo.x + 1, 10), run.integer(lo.y + 1, 10), run.integer(lo.z + 1, 10)};
        block.load(table, brick, min_weight, {lo, hi});
        compare(block, snapshot.grid, brick, min_weight, {lo, hi}, boxes);
      }
    }
  }
  std::cout << "voxel block: " << seeds << " maps, " << whole.known << " known and " << whole.unknown
            << " unknown voxels; in boxes " << boxes.known << " and " << boxes.unknown << '\n';
  EXPECT_EQ(whole.wrong, 0U);
  EXPECT_EQ(boxes.wrong, 0U);
  for (const std::size_t count : {whole.known, whole.unknown, boxes.known, boxes.unknown}) {
    EXPECT_GT(count, static_cast<std::size_t>(test::scaled_cases(500)));
  }
}

}  // namespace
}  // namespace saccade
