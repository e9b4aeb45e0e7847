// SPDX-License-Identifier: Apache-2.0
// Any sequence of changes: tests/property/shortest_path_forest_test.cpp.
#include "saccade/annotate/shortest_path_forest.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace saccade {
namespace {

/// Points 0 … n − 1 on a line, 1/8 m apart, so that all costs are exact.
ShortestPathForest forest_on_a_line(int points, double max_path) {
  PointCloud cloud;
  for (int i = 0; i < points; ++i) cloud.positions_m.emplace_back(0.125F * static_cast<float>(i), 0.0F, 0.0F);
  NeighbourhoodConfig config;
  config.neighbours = 2;
  config.position_weight_per_m = 1.0;
  config.normal_weight = 0.0;
  config.max_path = max_path;
  return ShortestPathForest{
      std::make_shared<const Neighbourhood>(Neighbourhood::build(cloud, config, Executor{}).value())};
}

std::string roots_of(const ShortestPathForest& forest) {
  std::string text;
  for (std::uint32_t point = 0; point < forest.neighbourhood().size(); ++point) {
    const auto root = forest.root_of(point);
    text += root ? std::to_string(*root) : ".";
  }
  return text;
}

TEST(ShortestPathForest, BelongsToTheNearestRootAndOfEqualOnesToTheLower) {
  ShortestPathForest forest = forest_on_a_line(9, 8.0);
  EXPECT_EQ(roots_of(forest), ".........");
  forest.add({8, 0.0});
  EXPECT_EQ(roots_of(forest), "888888888");
  forest.add({0, 0.0});
  EXPECT_EQ(roots_of(forest), "000008888");
  EXPECT_EQ(forest.path_length(3), 0.375);
  forest.add({4, 0.0});
  EXPECT_EQ(roots_of(forest), "000444488");
  forest.remove(0);
  EXPECT_EQ(roots_of(forest), "444444488");
  forest.remove(4);
  forest.remove(8);
  EXPECT_EQ(roots_of(forest), ".........");
  EXPECT_TRUE(std::isinf(forest.path_length(0)));
  EXPECT_TRUE(forest.roots().empty());
}

TEST(ShortestPathForest, APathIsShorterThanTheLongest) {
  ShortestPathForest forest = forest_on_a_line(9, 0.5);
  forest.add({4, 0.0});
  EXPECT_EQ(roots_of(forest), ".4444444.");
}

TEST(ShortestPathForest, AStartCostMakesARootTakeLess) {
  ShortestPathForest forest = forest_on_a_line(9, 1.0);
  forest.add({2, 0.0});
  forest.add({6, 0.25});
  EXPECT_EQ(roots_of(forest), "222222666");
  EXPECT_EQ(forest.path_length(6), 0.25);
  forest.add({8, 0.75});  // what it had is nearer to the others
  EXPECT_EQ(roots_of(forest), "222222666");
  EXPECT_TRUE(forest.is_root(8));
  forest.remove(6);
  EXPECT_EQ(roots_of(forest), "222222222");
  forest.remove(2);
  EXPECT_EQ(roots_of(forest), ".......88");
  EXPECT_EQ(forest.roots(), std::vector<Root>({{8, 0.75}}));
}

TEST(ShortestPathForest, RebuildsWhatChangesLeave) {
  ShortestPathForest forest = forest_on_a_line(40, 1.0);
  const std::vector<Root> roots{{3, 0.0}, {17, 0.5}, {30, 0.0}};
  forest.rebuild(roots);
  const std::string built = roots_of(forest);
  ShortestPathForest other = forest_on_a_line(40, 1.0);
  other.add({5, 0.0});
  for (const Root& root : {roots[2], roots[0], roots[1]}) other.add(root);
  other.remove(5);
  EXPECT_EQ(roots_of(other), built);
  EXPECT_EQ(other.roots(), roots);
  forest.rebuild({});
  EXPECT_EQ(roots_of(forest), std::string(40, '.'));
}

TEST(ShortestPathForest, WhatCannotBeIsABrokenContract) {
  ShortestPathForest forest = forest_on_a_line(5, 1.0);
  forest.add({2, 0.0});
  EXPECT_THROW(forest.add({2, 0.0}), ContractViolation);
  EXPECT_THROW(forest.add({5, 0.0}), ContractViolation);
  EXPECT_THROW(forest.add({1, 1.0}), ContractViolation);
  EXPECT_THROW(forest.add({1, -0.1}), ContractViolation);
  EXPECT_THROW(forest.remove(1), ContractViolation);
}

}  // namespace
}  // namespace saccade
