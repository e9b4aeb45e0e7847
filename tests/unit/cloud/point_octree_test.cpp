// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/point_octree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <tuple>

namespace saccade {
namespace {

constexpr float kNaN{std::numeric_limits<float>::quiet_NaN()};

/// Points on walls and a floor, with some in the air, and a few that are not finite.
std::vector<Eigen::Vector3f> street(std::size_t points, unsigned seed) {
  std::mt19937 random{seed};
  std::uniform_real_distribution<float> along{0.0F, 40.0F};
  std::vector<Eigen::Vector3f> cloud;
  for (std::size_t i = 0; i < points; ++i) {
    const float u = along(random);
    const float v = along(random) / 5.0F;
    switch (i % 10) {
      case 0: cloud.emplace_back(u, v, along(random) / 4.0F); break;
      case 1:
      case 2: cloud.emplace_back(u, 8.0F, v); break;
      case 3: cloud.emplace_back(i % 1000 == 3 ? kNaN : u, 0.0F, v); break;
      default: cloud.emplace_back(u, v, 0.0F);
    }
  }
  return cloud;
}

/// Checks what the class promises, whatever the cloud.
void expect_sound(const PointOctree& tree, const std::vector<Eigen::Vector3f>& cloud, std::size_t leaf_points) {
  std::vector<std::uint32_t> times(cloud.size(), 0);
  std::size_t first{0};
  std::vector<std::size_t> children(tree.nodes().size(), 0);
  for (std::size_t id = 0; id < tree.nodes().size(); ++id) {
    const PointOctree::Node& node = tree.nodes()[id];
    ASSERT_EQ(node.first, first) << "nodes follow one another in the order";
    first += node.count;
    ASSERT_GT(node.count, 0U);
    ASSERT_LE(node.count, PointOctree::kMostNodePoints);
    ASSERT_LE(node.level, PointOctree::kMostLevels);
    const double edge_m = tree.edge_m() / std::exp2(node.level);
    const Eigen::Vector3d least_m = tree.origin_m() + edge_m * Eigen::Vector3d(node.x, node.y, node.z);
    std::set<std::tuple<int, int, int>> cells;
    std::uint32_t before{0};
    for (const std::uint32_t point : tree.points(node)) {
      ASSERT_TRUE(cells.empty() || before < point) << "ascending";
      before = point;
      ++times[point];
      const Eigen::Vector3d inside_m = cloud[point].cast<double>() - least_m;
      ASSERT_GE(inside_m.minCoeff(), -1e-9 * tree.edge_m());
      ASSERT_LE(inside_m.maxCoeff(), edge_m + 1e-9 * tree.edge_m());
      if (node.spacing_m == 0.0F) continue;
      const Eigen::Vector3d cell = inside_m / node.spacing_m;
      ASSERT_TRUE(
          cells.insert({static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())}).second)
          << "one point of a cell";
    }
    if (id == 0) {
      ASSERT_EQ(node.parent, PointOctree::kNoNode);
      continue;
    }
    ASSERT_LT(node.parent, id);
    ++children[node.parent];
    const PointOctree::Node& parent = tree.nodes()[node.parent];
    if (parent.level == node.level) {
      ASSERT_EQ(node.level, PointOctree::kMostLevels);
      ASSERT_EQ(parent.count, PointOctree::kMostNodePoints);
    } else {
      ASSERT_EQ(node.level, parent.level + 1);
      ASSERT_EQ(std::tuple(node.x / 2, node.y / 2, node.z / 2), std::tuple(parent.x, parent.y, parent.z));
      ASSERT_GT(parent.spacing_m, 0.0F);
      ASSERT_LE(node.spacing_m, 2.0F * parent.spacing_m);
    }
  }
  for (std::size_t id = 0; id < tree.nodes().size(); ++id) {
    if (tree.nodes()[id].spacing_m == 0.0F && tree.nodes()[id].level < PointOctree::kMostLevels) {
      ASSERT_LE(tree.nodes()[id].count, leaf_points);
      ASSERT_EQ(children[id], 0U);
    }
  }
  for (std::size_t point = 0; point < cloud.size(); ++point) {
    ASSERT_EQ(times[point], cloud[point].allFinite() ? 1U : 0U) << "point " << point;
  }
  ASSERT_EQ(first, tree.order().size());
}

TEST(PointOctree, EachFinitePointIsInOneNodeInsideItsCube) {
  for (const unsigned seed : {1U, 2U}) {
    const std::vector<Eigen::Vector3f> cloud = street(60'000, seed);
    const PointOctree tree{cloud, {2'000}, Executor{}};
    expect_sound(tree, cloud, 2'000);
    EXPECT_GT(tree.nodes().size(), 8U);
    EXPECT_GT(tree.nodes().back().level, 1U);
  }
}

TEST(PointOctree, TheFirstLevelsShowTheWholeCloud) {
  const std::vector<Eigen::Vector3f> cloud = street(60'000, 3);
  const PointOctree tree{cloud, {2'000}, Executor{}};
  const PointOctree::Node& root = tree.nodes().front();
  EXPECT_LT(root.count, cloud.size() / 2);
  // Every point has one of the root's in its own cell or it is that one.
  const auto cell_of = [&](const Eigen::Vector3f& p) {
    const Eigen::Vector3d cell = (p.cast<double>() - tree.origin_m()) / root.spacing_m;
    return std::tuple(static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z()));
  };
  std::set<std::tuple<int, int, int>> shown;
  for (const std::uint32_t point : tree.points(root)) shown.insert(cell_of(cloud[point]));
  for (const Eigen::Vector3f& p : cloud) {
    ASSERT_TRUE(!p.allFinite() || shown.contains(cell_of(p)));
  }
}

TEST(PointOctree, ThreadsChangeNothing) {
  const std::vector<Eigen::Vector3f> cloud = street(40'000, 4);
  const PointOctree one{cloud, {500}, Executor{}};
  const PointOctree four{cloud, {500}, Executor::with_threads(4, Executor::Backend::std_thread)};
  ASSERT_EQ(one.nodes().size(), four.nodes().size());
  EXPECT_TRUE(std::equal(one.order().begin(), one.order().end(), four.order().begin()));
  const std::vector<std::uint32_t> nodes = one.nodes_of_points(cloud.size(), Executor{});
  for (std::size_t id = 0; id < one.nodes().size(); ++id) {
    EXPECT_EQ(one.nodes()[id].first, four.nodes()[id].first);
    for (const std::uint32_t point : one.points(one.nodes()[id])) ASSERT_EQ(nodes[point], id);
  }
  EXPECT_EQ(nodes[3], PointOctree::kNoNode);
}

TEST(PointOctree, CoincidentPointsEnd) {
  std::vector<Eigen::Vector3f> cloud(150'000, Eigen::Vector3f{1.0F, 2.0F, 3.0F});
  const PointOctree alone{cloud, {1'000}, Executor{}};
  expect_sound(alone, cloud, 1'000);
  cloud.emplace_back(4.0F, 2.0F, 3.0F);
  cloud.emplace_back(4.0F, 5.0F, 9.0F);
  const PointOctree among{cloud, {1'000}, Executor{}};
  expect_sound(among, cloud, 1'000);
  EXPECT_LT(among.nodes().size(), 32U);
}

TEST(PointOctree, OfFewPointsOrNone) {
  const std::vector<Eigen::Vector3f> none{{kNaN, 0.0F, 0.0F}};
  EXPECT_TRUE((PointOctree{none, {}, Executor{}}.nodes().empty()));
  EXPECT_TRUE((PointOctree{{}, {}, Executor{}}.nodes().empty()));
  const std::vector<Eigen::Vector3f> one{{5.0F, 0.0F, 0.0F}};
  const PointOctree tree{one, {}, Executor{}};
  expect_sound(tree, one, 20'000);
  EXPECT_EQ(tree.nodes().size(), 1U);
}

TEST(PointOctree, ANodeOfAFilledVolumeIsBounded) {
  std::mt19937 random{5};
  std::uniform_real_distribution<float> within{0.0F, 1.0F};
  std::vector<Eigen::Vector3f> cloud;
  for (int i = 0; i < 200'000; ++i) cloud.emplace_back(within(random), within(random), within(random));
  const PointOctree tree{cloud, {}, Executor{}};
  expect_sound(tree, cloud, 20'000);
  EXPECT_FLOAT_EQ(tree.nodes().front().spacing_m, static_cast<float>(tree.edge_m() / 32));
}

}  // namespace
}  // namespace saccade
