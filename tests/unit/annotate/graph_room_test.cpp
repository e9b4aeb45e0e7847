// SPDX-License-Identifier: Apache-2.0
// A graph on disk is the graph in memory; a disk without room is an error.
#include "saccade/annotate/graph_room.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "support/small_disk.hpp"
#include "support/temp_folder.hpp"

namespace saccade::test {
namespace {

PointCloud random_cloud(std::size_t count, bool has_normals) {
  std::mt19937 random{5};
  std::uniform_int_distribution<int> steps{0, 60};  // several points at one distance, and at one place
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const auto coordinate = [&] { return 0.01F * static_cast<float>(steps(random)); };
    cloud.positions_m.emplace_back(coordinate(), coordinate(), coordinate());
    cloud.colors.emplace_back(coordinate(), coordinate(), coordinate());
    if (has_normals) cloud.normals.push_back(Eigen::Vector3f{coordinate(), coordinate(), 1.0F}.normalized());
  }
  cloud.positions_m[count / 2].x() = std::numeric_limits<float>::quiet_NaN();
  return cloud;
}

void expect_equal(const Neighbourhood& a, const Neighbourhood& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a.median_cost(), b.median_cost());
  for (std::uint32_t node = 0; node < a.size(); ++node) {
    ASSERT_EQ(a.point_of(node), b.point_of(node));
    const auto of_a = a.edges(node);
    const auto of_b = b.edges(node);
    ASSERT_TRUE(std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                           [](const auto& p, const auto& q) { return p.node == q.node && p.cost == q.cost; }));
  }
}

TEST(GraphRoom, AGraphOnDiskIsTheSame) {
  const TempFolder folder;
  for (const int neighbours : {1, 10, 33, 64}) {
    NeighbourhoodConfig config;
    config.neighbours = neighbours;
    config.strong_borders = neighbours != 10;
    const PointCloud cloud = random_cloud(5000, neighbours == 33);
    const Executor executor = Executor::with_threads(2);
    EXPECT_FALSE(GraphRoom{}.needs_disk(cloud.positions_m.size(), config));
    EXPECT_TRUE((GraphRoom{1000, folder.path()}.needs_disk(cloud.positions_m.size(), config)));
    const auto in_memory = build_graph(cloud, config, {}, executor);
    const auto on_disk = build_graph(cloud, config, {1000, folder.path()}, executor);
    ASSERT_TRUE(in_memory && on_disk);
    expect_equal(*in_memory, *on_disk);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  }
}

TEST(GraphRoom, SaysThatTheDiskIsFull) {
  const TempFolder folder;
  const PointCloud cloud = random_cloud(100'000, false);
  const SmallDisk full{1U << 20U};
  const auto graph = build_graph(cloud, {}, {1000, folder.path()}, Executor::with_threads(1));
  ASSERT_FALSE(graph);
  EXPECT_EQ(graph.error().code, Errc::io_failure);
  EXPECT_NE(graph.error().message.find("no room"), std::string::npos);
  EXPECT_EQ(build_graph(cloud, {}, {1000, folder / "missing"}, Executor::with_threads(1)).error().code,
            Errc::io_failure);
}

}  // namespace
}  // namespace saccade::test
