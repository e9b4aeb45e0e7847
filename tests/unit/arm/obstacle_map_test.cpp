// SPDX-License-Identifier: Apache-2.0
// Obstacles of hand-made maps: which cells, how far, what is refused.
#include "saccade/arm/obstacle_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "saccade/arm/internal/obstacle_cells.hpp"
#include "saccade/core/simd.hpp"

namespace saccade {
namespace {

constexpr double kVoxel_m{0.01};

TsdfConfig config_of(const Box& workspace) {
  TsdfConfig config;
  config.voxel_size_m = kVoxel_m;
  config.workspace = workspace;
  return config;
}

/// A workspace of 1 m around the origin, all of it free.
TsdfMap free_map() {
  TsdfMap map = TsdfMap::create(config_of({{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}})).value();
  EXPECT_TRUE(map.free(Box{{-0.6, -0.6, -0.6}, {0.6, 0.6, 0.6}}).ok());
  return map;
}

void forget_voxel(TsdfMap& map, const Index3& voxel) {
  EXPECT_TRUE(map.forget(Sphere{voxel_center(voxel, kVoxel_m), 0.6 * kVoxel_m}).ok());
}

ObstacleMap obstacles_of(const TsdfMap& map, const ObstacleConfig& config = {}) {
  return ObstacleMap::create(map.snapshot(), config, {}).value();
}

TEST(ObstacleMap, OfAnUnseenMapIsSolid) {
  const TsdfMap map = TsdfMap::create(config_of({{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}})).value();
  const ObstacleMap obstacles = obstacles_of(map);
  // 100 voxels from -50 on, four per cell, from cell -13 (half of it) to cell 12.
  EXPECT_EQ(obstacles.cells().box(), (IndexBox{{-13, -13, -13}, {13, 13, 13}}));
  EXPECT_EQ(obstacles.cells().obstacle_count(), 26U * 26U * 26U);
  EXPECT_FALSE(obstacles.clear({0.1, 0.2, 0.3}, 0.0));
  EXPECT_TRUE(obstacles.clear({0.6, 0.0, 0.0}, 0.0799));  // the last cell ends at 0.52
  EXPECT_FALSE(obstacles.clear({0.6, 0.0, 0.0}, 0.0801));
  EXPECT_NEAR(obstacles.distance_m({0.6, 0.0, 0.0}), 0.08, 1e-9);
  EXPECT_EQ(obstacles.boxes().size(), obstacles.cells().obstacle_count());
}

TEST(ObstacleMap, UnknownSpaceCanBeLeftOut) {
  const TsdfMap map = TsdfMap::create(config_of({{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}})).value();
  ObstacleConfig config;
  config.unknown_is_obstacle = false;
  const ObstacleMap obstacles = obstacles_of(map, config);
  EXPECT_EQ(obstacles.cells().obstacle_count(), 0U);
  EXPECT_TRUE(obstacles.clear({0.0, 0.0, 0.0}, 100.0));
  EXPECT_EQ(obstacles.distance_m({0.0, 0.0, 0.0}), config.max_distance_m);
  EXPECT_NEAR(obstacles.distance_bound_m({0.0, 0.0, 0.0}), config.max_distance_m, 0.07);
}

TEST(ObstacleMap, OneVoxelMakesItsCellAnObstacle) {
  TsdfMap map = free_map();
  forget_voxel(map, {7, -1, 20});  // cell 1, -1, 5
  const ObstacleMap obstacles = obstacles_of(map);
  EXPECT_EQ(obstacles.cells().obstacle_count(), 1U);
  EXPECT_TRUE(obstacles.cells().is_obstacle({1, -1, 5}));
  EXPECT_FALSE(obstacles.cells().is_obstacle({0, -1, 5}));
  EXPECT_FALSE(obstacles.cells().is_obstacle({100, 0, 0}));
  const std::vector<Box> boxes = obstacles.boxes();
  ASSERT_EQ(boxes.size(), 1U);
  EXPECT_TRUE(boxes[0].min.isApprox(Eigen::Vector3d{0.04, -0.04, 0.2}, 1e-12));
  EXPECT_TRUE(boxes[0].max.isApprox(Eigen::Vector3d{0.08, 0.0, 0.24}, 1e-12));
  EXPECT_NEAR(obstacles.distance_m({0.0, -0.02, 0.22}), 0.04, 1e-9);
  EXPECT_NEAR(obstacles.distance_m({0.11, 0.04, 0.22}), 0.05, 1e-9);  // 3-4-5 from an edge
  EXPECT_EQ(obstacles.distance_m({0.05, -0.02, 0.22}), 0.0);
  EXPECT_TRUE(obstacles.clear({0.11, 0.04, 0.22}, 0.04999));
  EXPECT_FALSE(obstacles.clear({0.11, 0.04, 0.22}, 0.05001));
}

TEST(ObstacleMap, TouchingIsNotClear) {
  TsdfMap map = free_map();
  forget_voxel(map, {0, 0, 0});
  ObstacleConfig config;
  config.fixtures = {Box{{1.0, 1.0, 1.0}, {2.0, 2.0, 2.0}}};
  const ObstacleMap obstacles = obstacles_of(map, config);
  EXPECT_FALSE(obstacles.clear({-0.25, 0.02, 0.02}, 0.25));
  EXPECT_FALSE(obstacles.clear({0.75, 1.5, 1.5}, 0.25));
  EXPECT_TRUE(obstacles.clear({0.75, 1.5, 1.5}, 0.2499999));
}

TEST(ObstacleMap, FixturesCountInsideAndOutsideOfTheWorkspace) {
  const TsdfMap map = free_map();
  ObstacleConfig config;
  config.fixtures = {Box{{0.1, 0.1, 0.1}, {0.133, 0.2, 0.2}}, Box{{-3.0, -3.0, -1.0}, {3.0, 3.0, -0.75}}};
  const ObstacleMap obstacles = obstacles_of(map, config);
  EXPECT_EQ(obstacles.cells().obstacle_count(), 0U);
  EXPECT_EQ(obstacles.boxes().size(), 2U);
  EXPECT_NEAR(obstacles.distance_m({0.2, 0.15, 0.15}), 0.067, 1e-9);
  EXPECT_TRUE(obstacles.clear({0.2, 0.15, 0.15}, 0.0669));
  EXPECT_FALSE(obstacles.clear({0.2, 0.15, 0.15}, 0.0671));
  EXPECT_NEAR(obstacles.distance_m({0.0, 0.0, -0.6}), 0.15, 1e-9);  // between the workspace and the table
  EXPECT_TRUE(obstacles.clear({2.5, 2.5, -0.6}, 0.1499));
  EXPECT_FALSE(obstacles.clear({2.5, 2.5, -0.6}, 0.1501));
  EXPECT_FALSE(obstacles.clear({2.5, 2.5, -0.9}, 0.0));
  EXPECT_TRUE(obstacles.clear({5.0, 5.0, 5.0}, 1.0));
}

TEST(ObstacleMap, OnlyTheWorkspaceCounts) {
  TsdfMap map = free_map();
  EXPECT_TRUE(map.forget(Box{{0.5, -0.6, -0.6}, {0.6, 0.6, 0.6}}).ok());  // just beyond it
  EXPECT_EQ(obstacles_of(map).cells().obstacle_count(), 0U);
  forget_voxel(map, {49, 0, 0});  // its last voxel
  EXPECT_EQ(obstacles_of(map).cells().obstacle_count(), 1U);
}

TEST(ObstacleMap, FollowsTheMap) {
  TsdfMap map = free_map();
  ObstacleMap obstacles = obstacles_of(map);
  const ObstacleUpdate nothing = obstacles.update(map.snapshot(), {}).value();
  EXPECT_EQ(nothing.bricks, 0U);
  EXPECT_EQ(nothing.cells, 0U);
  forget_voxel(map, {7, -1, 20});
  const ObstacleUpdate one = obstacles.update(map.snapshot(), {}).value();
  EXPECT_EQ(one.bricks, 1U);
  EXPECT_EQ(one.cells, 1U);
  EXPECT_TRUE(obstacles.cells().is_obstacle({1, -1, 5}));
  EXPECT_NEAR(obstacles.distance_m({0.0, -0.02, 0.22}), 0.04, 1e-9);
  forget_voxel(map, {6, -2, 21});  // the same cell
  const ObstacleUpdate same_cell = obstacles.update(map.snapshot(), {}).value();
  EXPECT_EQ(same_cell.bricks, 1U);
  EXPECT_EQ(same_cell.cells, 0U);
  EXPECT_TRUE(map.free(Box{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}).ok());
  EXPECT_EQ(obstacles.update(map.snapshot(), {}).value().cells, 1U);
  EXPECT_EQ(obstacles.cells().obstacle_count(), 0U);
}

TEST(ObstacleMap, CellsAreTheNearestWholeNumberOfVoxels) {
  TsdfConfig config = config_of({{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}});
  const auto voxels_along = [&](double voxel_size_m, double cell_size_m) {
    config.voxel_size_m = voxel_size_m;
    return ObstacleCells::create(config, cell_size_m, true).value().voxels_along_cell();
  };
  EXPECT_EQ(voxels_along(0.0058, 0.04), 7);
  EXPECT_EQ(voxels_along(0.01, 0.04), 4);
  EXPECT_EQ(voxels_along(0.03, 0.04), 1);
  EXPECT_EQ(voxels_along(0.1, 0.04), 1);
  EXPECT_NEAR(ObstacleCells::create(config, 0.29, true).value().cell_edge_m(), 0.3, 1e-12);
}

TEST(ObstacleMap, SpheresThatAreNotFiniteAreNotClear) {
  ObstacleConfig config;
  config.fixtures = {Box{{1.0, 1.0, 1.0}, {2.0, 2.0, 2.0}}};
  const ObstacleMap obstacles = obstacles_of(free_map(), config);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, infinity, -infinity}) {
    for (std::size_t i = 0; i < 4; ++i) {
      std::array<float, 4> sphere{0.0F, 0.0F, 0.0F, 0.01F};
      const auto first = [&] {
        return obstacles.first_touching({{&sphere[0], 1}, {&sphere[1], 1}, {&sphere[2], 1}, {&sphere[3], 1}});
      };
      EXPECT_EQ(first(), 1U);
      sphere[i] = bad;
      EXPECT_EQ(first(), 0U) << bad << " at " << i;
      float clearance{0.0F};
      obstacles.clearance_bounds({{&sphere[0], 1}, {&sphere[1], 1}, {&sphere[2], 1}, {&sphere[3], 1}}, {&clearance, 1});
      EXPECT_EQ(clearance, -infinity);
      EXPECT_FALSE(obstacles.clear({sphere[0], sphere[1], sphere[2]}, sphere[3]));
    }
    EXPECT_EQ(obstacles.distance_m({bad, 0.0, 0.0}), 0.0);
    EXPECT_EQ(obstacles.distance_bound_m({bad, 0.0, 0.0}), 0.0);
  }
  EXPECT_TRUE(obstacles.clear({1e20, 0.0, 0.0}, 1.0));
  EXPECT_FALSE(obstacles.clear({1e20, 0.0, 0.0}, 1e30));
}

std::string refusal(const TsdfConfig& map, const ObstacleConfig& config) {
  const auto made = ObstacleMap::create(TsdfSnapshot{map, {}}, config, {});
  EXPECT_FALSE(made.ok());
  if (made.ok()) return {};
  EXPECT_EQ(made.error().code, Errc::invalid_argument);
  return made.error().message;
}

TEST(ObstacleMap, SaysWhatIsWrong) {
  const TsdfConfig map = config_of({{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}});
  const auto with = [](auto change) {
    ObstacleConfig config;
    change(config);
    return config;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  TsdfConfig no_workspace = map;
  no_workspace.workspace.reset();
  EXPECT_NE(refusal(no_workspace, {}).find("no workspace"), std::string::npos);
  for (const double size : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(refusal(map, with([&](auto& c) { c.cell_size_m = size; })), "the cell size must be positive");
  }
  EXPECT_NE(refusal(map, with([](auto& c) { c.cell_size_m = 2.6; })).find("256 voxels"), std::string::npos);
  EXPECT_EQ(refusal(map, with([](auto& c) { c.max_distance_m = 0.0; })), "the maximum distance must be positive");
  EXPECT_NE(refusal(map, with([](auto& c) { c.max_distance_m = 5.1; })).find("127 cells"), std::string::npos);
  EXPECT_NE(refusal(map, with([](auto& c) {
                      c.fixtures = {Box{{0, 0, 0}, {1, 1, 1}}, Box{{0, 0, 0}, {1, -1, 1}}};
                    }))
                .find("fixture 2"),
            std::string::npos);
  const TsdfConfig large = config_of({{-5.0, -5.0, -5.0}, {5.0, 5.0, 5.0}});
  EXPECT_NE(refusal(large, with([](auto& c) { c.cell_size_m = 0.01; })).find("cells"), std::string::npos);
  const TsdfConfig tiny = config_of({{0.001, 0.001, 0.001}, {0.002, 0.002, 0.002}});
  EXPECT_NE(refusal(tiny, {}).find("no voxel"), std::string::npos);
}

TEST(ObstacleMap, RefusesAnotherMap) {
  ObstacleMap obstacles = obstacles_of(free_map());
  TsdfSnapshot other = free_map().snapshot();
  other.config.voxel_size_m = 0.02;
  EXPECT_EQ(obstacles.update(other, {}).error().message, "the map has another voxel size than before");
  other = free_map().snapshot();
  other.config.workspace->max.x() = 0.4;
  EXPECT_EQ(obstacles.update(other, {}).error().message, "the map has another workspace than before");
  other.config.workspace.reset();
  EXPECT_FALSE(obstacles.update(other, {}).ok());
  EXPECT_EQ(obstacles.cells().obstacle_count(), 0U);
}

}  // namespace
}  // namespace saccade
