// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/map_changes.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "analytic_map.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade {
namespace {

TsdfSnapshot ball() {
  TsdfConfig config;
  config.voxel_size_m = 0.01;
  return test::map_of(config, {{-70, -30, -30}, {70, 30, 30}}, [](const Eigen::Vector3d& p) {
    return test::sphere_sdf(p, {0.02, 0.01, 0.0}, 0.2);
  });
}

BrickRef& writable_brick(TsdfGrid& grid, const Index3& brick) {
  return grid.writable(parent(brick)).bricks[static_cast<std::size_t>(child_index(brick))];
}

TEST(MapChanges, OfOneStateAreNone) {
  const TsdfSnapshot map = ball();
  const TsdfSnapshot shared = map;
  EXPECT_TRUE(changed_bricks(map.grid, map.grid, {}).empty());
  EXPECT_TRUE(changed_bricks(map.grid, shared.grid, {}).empty());
  EXPECT_TRUE(changed_bricks(map.grid, ball().grid, {}).empty()) << "equal content that nothing shares";
  EXPECT_TRUE(changed_bricks({}, {}, {}).empty());
}

TEST(MapChanges, FromAndToNothingAreAllBricksThatHoldAnything) {
  const TsdfSnapshot map = ball();
  const std::size_t bricks = map.grid.usage().bricks();
  ASSERT_GT(bricks, 500U);
  EXPECT_EQ(changed_bricks({}, map.grid, {}).size(), bricks);
  EXPECT_EQ(changed_bricks(map.grid, {}, {}), changed_bricks({}, map.grid, {}));
}

TEST(MapChanges, NameTheBrickWithOneOtherVoxelWeightOrColor) {
  const TsdfSnapshot before = ball();
  const Index3 brick{-3, 0, 1};  // across the surface, in a sector of negative index
  TsdfSnapshot after = before;
  ASSERT_EQ(writable_brick(after.grid, brick).kind(), BrickKind::dense);
  DenseBrick& dense = writable_brick(after.grid, brick).writable_dense();
  EXPECT_TRUE(changed_bricks(before.grid, after.grid, {}).empty()) << "unshared, with the content it had";

  ++dense.w[511];
  EXPECT_EQ(changed_bricks(before.grid, after.grid, {}), std::vector{brick});
  --dense.w[511];
  --dense.v[7];
  EXPECT_EQ(changed_bricks(before.grid, after.grid, {}), std::vector{brick});
  ++dense.v[7];
  dense.colors = std::make_unique<BrickColors>();
  (*dense.colors)[3] = {1, 2, 3};
  EXPECT_EQ(changed_bricks(before.grid, after.grid, {}), std::vector{brick});
}

TEST(MapChanges, CountedFreeSpaceIsOneAndForgottenIsAnother) {
  TsdfSnapshot before;
  const Index3 brick{9, -1, 0};
  writable_brick(before.grid, brick) = BrickRef::constant_free(2);
  TsdfSnapshot after = before;
  EXPECT_TRUE(changed_bricks(before.grid, after.grid, {}).empty());
  writable_brick(after.grid, brick) = BrickRef::constant_free(3);
  EXPECT_EQ(changed_bricks(before.grid, after.grid, {}), std::vector{brick});
  writable_brick(after.grid, brick) = {};
  EXPECT_EQ(changed_bricks(before.grid, after.grid, {}), std::vector{brick});
  after.grid.erase(parent(brick));
  EXPECT_EQ(changed_bricks(before.grid, after.grid, {}), std::vector{brick});
  EXPECT_TRUE(changed_bricks({}, TsdfMap::create({})->content().grid, {}).empty());
}

TEST(MapChanges, NeighborsAreTheTwentySixAround) {
  const unsigned seed{5};
  SCOPED_TRACE(seed);
  std::mt19937 random{seed};
  const auto number = [&](int lo, int hi) { return std::uniform_int_distribution{lo, hi}(random); };
  const auto less = [](const Index3& a, const Index3& b) {
    return parent(a) == parent(b) ? child_index(a) < child_index(b) : zyx_less(parent(a), parent(b));
  };
  std::size_t compared{0};
  for (int round = 0; round < 50; ++round) {
    std::map<Index3, Mask512, decltype(&zyx_less)> marked{&zyx_less};
    std::set<Index3, decltype(less)> expected{less};
    for (int n = number(0, 30); n > 0; --n) {
      const Index3 brick{number(-9, 17), number(-9, 9), number(-2, 9)};
      marked[parent(brick)].set(child_index(brick));
      for (int i = 0; i < 27; ++i) expected.insert(brick + Index3{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1});
    }
    std::vector<SectorBricks> sectors;
    for (const auto& [sector, bricks] : marked) sectors.push_back({sector, bricks});
    std::vector<Index3> grown;
    for (const SectorBricks& sector : with_neighbors(sectors)) {
      EXPECT_TRUE(sector.bricks.any());
      sector.bricks.for_each(
          [&](std::size_t i) { grown.push_back(sector.sector * kSectorEdge + child_offset(static_cast<int>(i))); });
    }
    ASSERT_EQ(grown, (std::vector<Index3>{expected.begin(), expected.end()})) << "round " << round;
    compared += grown.size();
  }
  EXPECT_GT(compared, 10000U);
}

}  // namespace
}  // namespace saccade
