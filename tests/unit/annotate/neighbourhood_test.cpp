// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/neighbourhood.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace saccade {
namespace {

NeighbourhoodConfig with_neighbours(int neighbours) {
  NeighbourhoodConfig config;
  config.neighbours = neighbours;
  return config;
}

Neighbourhood built(const PointCloud& cloud, const NeighbourhoodConfig& config) {
  return Neighbourhood::build(cloud, config, Executor::with_threads(2)).value();
}

/// In path units; nothing: they are no neighbours.
std::optional<std::uint32_t> cost_between(const Neighbourhood& graph, std::uint32_t a, std::uint32_t b) {
  for (const Neighbourhood::Edge& edge : graph.edges(graph.node_of(a))) {
    if (graph.point_of(edge.node) == b) return edge.cost;
  }
  return std::nullopt;
}

PointCloud random_cloud(std::size_t count) {
  std::mt19937 random{11};
  std::uniform_real_distribution<float> uniform{0.0F, 1.0F};
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    cloud.positions_m.emplace_back(uniform(random), uniform(random), 0.1F * uniform(random));
    cloud.normals.push_back(Eigen::Vector3f{uniform(random), uniform(random), 1.0F}.normalized());
    cloud.colors.emplace_back(uniform(random), uniform(random), uniform(random));
  }
  return cloud;
}

TEST(Neighbourhood, AnEdgeCostsWhatEquation417Says) {
  const PointCloud cloud = random_cloud(400);
  NeighbourhoodConfig config;
  config.position_weight_per_m = 2.0;
  config.normal_weight = 0.25;
  config.color_weight = 0.125;
  config.max_path = 3.0;
  const Neighbourhood graph = built(cloud, config);
  std::size_t edges{0};
  for (std::uint32_t a = 0; a < graph.size(); ++a) {
    for (const Neighbourhood::Edge& edge : graph.edges(graph.node_of(a))) {
      const std::uint32_t b = graph.point_of(edge.node);
      const double expected = 2.0 * static_cast<double>((cloud.positions_m[a] - cloud.positions_m[b]).norm()) +
                              0.25 * (1.0 - static_cast<double>(cloud.normals[a].dot(cloud.normals[b]))) +
                              0.125 * static_cast<double>((cloud.colors[a] - cloud.colors[b]).norm());
      EXPECT_NEAR(edge.cost / static_cast<double>(kPathUnits) * config.max_path, expected, 1e-6);
      EXPECT_EQ(cost_between(graph, b, a), edge.cost);
      ++edges;
    }
  }
  EXPECT_EQ(edges, 2 * graph.edge_count());
}

TEST(Neighbourhood, JoinsThoseOfWhichOneIsANearestOfTheOther) {
  PointCloud cloud;
  for (const float x : {0.0F, 1.0F, 3.0F, 7.0F}) cloud.positions_m.emplace_back(x, 0.0F, 0.0F);
  NeighbourhoodConfig config = with_neighbours(1);
  config.max_path = 100.0;
  const Neighbourhood graph = built(cloud, config);
  EXPECT_EQ(graph.edge_count(), 3U);
  for (const auto& [a, b] : {std::pair{0U, 1U}, {1U, 2U}, {2U, 3U}}) EXPECT_TRUE(cost_between(graph, a, b));
  EXPECT_FALSE(cost_between(graph, 0, 2));
}

TEST(Neighbourhood, EdgesAreThereOnceBothWaysWhereManyPointsAreAsNear) {
  PointCloud cloud;  // a grid, some of whose points are there several times
  for (int i = 0; i < 900; ++i) {
    const Eigen::Vector3f p{static_cast<float>(i % 30), static_cast<float>(i / 30), 0.0F};
    for (int copy = 0; copy < (i % 7 == 0 ? 3 : 1); ++copy) cloud.positions_m.push_back(p);
  }
  NeighbourhoodConfig config;
  config.max_path = 100.0;
  const Neighbourhood graph = built(cloud, config);
  for (std::uint32_t a = 0; a < graph.size(); ++a) {
    std::set<std::uint32_t> others;
    for (const Neighbourhood::Edge& edge : graph.edges(graph.node_of(a))) {
      EXPECT_TRUE(others.insert(edge.node).second);
      EXPECT_EQ(cost_between(graph, graph.point_of(edge.node), a), edge.cost);
    }
    EXPECT_GE(others.size(), 10U);
  }
}

TEST(Neighbourhood, ManyPointsAtOnePlaceAreJoinedToTheOthers) {
  PointCloud cloud;  // a grid, twelve times, in two colours
  for (int i = 0; i < 100; ++i) {
    for (int copy = 0; copy < 12; ++copy) {
      cloud.positions_m.emplace_back(static_cast<float>(i % 10), static_cast<float>(i / 10), 0.0F);
      cloud.colors.push_back(Eigen::Vector3f::Constant(copy % 2 == 0 ? 0.0F : 1.0F));
    }
  }
  NeighbourhoodConfig config;
  config.strong_borders = true;
  const Neighbourhood graph = built(cloud, config);
  std::vector<std::uint32_t> reached{0};
  std::set<std::uint32_t> seen{0};
  while (!reached.empty()) {
    const std::uint32_t point = reached.back();
    reached.pop_back();
    for (const Neighbourhood::Edge& edge : graph.edges(graph.node_of(point))) {
      const std::uint32_t other = graph.point_of(edge.node);
      EXPECT_EQ(cost_between(graph, other, point), edge.cost);
      if (seen.insert(other).second) reached.push_back(other);
    }
  }
  EXPECT_EQ(seen.size(), cloud.positions_m.size());
  EXPECT_EQ(cost_between(graph, 0, 2), 0U);
  EXPECT_GT(cost_between(graph, 0, 1).value_or(0), 0U);

  config.strong_borders = false;  // as printed: among copies alone
  EXPECT_FALSE(cost_between(built(cloud, config), 0, 12));
}

TEST(Neighbourhood, EstimatedNormalsHaveNoSides) {
  PointCloud cloud;  // a sheet, and another that stands on it
  for (int i = 0; i < 400; ++i) {
    cloud.positions_m.emplace_back(0.01F * static_cast<float>(i % 20), 0.01F * static_cast<float>(i / 20), 0.0F);
    cloud.positions_m.emplace_back(0.01F * static_cast<float>(i % 20), 0.1F, 0.01F * static_cast<float>(1 + i / 20));
  }
  NeighbourhoodConfig config;
  config.position_weight_per_m = 0.0;
  const Neighbourhood graph = built(cloud, config);
  std::uint32_t in_a_sheet{0};
  std::uint32_t most{0};
  for (std::uint32_t a = 0; a < graph.size(); ++a) {
    const Eigen::Vector3f& p = cloud.positions_m[a];
    for (const Neighbourhood::Edge& edge : graph.edges(graph.node_of(a))) {
      most = std::max(most, edge.cost);
      const bool far_from_the_fold = p.z() == 0.0F && p.y() < 0.03F;
      if (far_from_the_fold) in_a_sheet = std::max(in_a_sheet, edge.cost);
    }
  }
  EXPECT_LT(in_a_sheet, kPathUnits / 10000);
  EXPECT_GT(most, kPathUnits / 100);
}

TEST(Neighbourhood, WithoutNormalsAndColoursOnlyPlacesCount) {
  PointCloud cloud;
  cloud.positions_m = random_cloud(50).positions_m;
  NeighbourhoodConfig config;
  config.position_weight_per_m = 0.5;
  config.normal_weight = 0.0;
  config.max_path = 2.0;
  const Neighbourhood graph = built(cloud, config);
  const Neighbourhood::Edge& edge = graph.edges(0).front();
  const double distance_m =
      static_cast<double>((cloud.positions_m[graph.point_of(0)] - cloud.positions_m[graph.point_of(edge.node)]).norm());
  EXPECT_NEAR(edge.cost / static_cast<double>(kPathUnits), distance_m / 4.0, 1e-6);
}

TEST(Neighbourhood, AdaptedToDensityAThinCloudCostsAsADenseOne) {
  PointCloud cloud;  // the right half is ten times as sparse
  for (int i = 0; i < 100; ++i) cloud.positions_m.emplace_back(0.01F * static_cast<float>(i), 0.0F, 0.0F);
  for (int i = 0; i < 100; ++i) cloud.positions_m.emplace_back(1.0F + 0.1F * static_cast<float>(i), 0.0F, 0.0F);
  NeighbourhoodConfig config = with_neighbours(2);
  config.position_weight_per_m = 1.0;
  config.normal_weight = 0.0;
  config.max_path = 1.0;
  EXPECT_NEAR(*cost_between(built(cloud, config), 150, 151) / static_cast<double>(kPathUnits), 0.1, 1e-5);
  config.adapt_to_density = true;
  const Neighbourhood adapted = built(cloud, config);
  EXPECT_EQ(*cost_between(adapted, 150, 151) / 1000, *cost_between(adapted, 50, 51) / 1000);
}

TEST(Neighbourhood, OfOddCloudsIsClear) {
  EXPECT_EQ(built({}, {}).size(), 0U);
  PointCloud cloud;
  cloud.positions_m.emplace_back(1.0F, 2.0F, 3.0F);
  EXPECT_EQ(built(cloud, {}).edge_count(), 0U);
  cloud.positions_m.emplace_back(std::numeric_limits<float>::quiet_NaN(), 2.0F, 3.0F);
  cloud.positions_m.emplace_back(1.0F, 2.0F, 3.5F);
  const Neighbourhood graph = built(cloud, {});
  EXPECT_EQ(graph.size(), 3U);
  EXPECT_EQ(graph.edge_count(), 1U);
  EXPECT_TRUE(graph.edges(graph.node_of(1)).empty());
  for (std::uint32_t point = 0; point < 3; ++point) EXPECT_EQ(graph.point_of(graph.node_of(point)), point);
  cloud.positions_m.assign(500, Eigen::Vector3f::Ones());
  const Neighbourhood same = built(cloud, {});
  EXPECT_GE(same.edge_count(), 500U * 10U / 2U);
  EXPECT_EQ(same.edges(0).front().cost, 0U);
}

TEST(Neighbourhood, IsTheSameForEveryThreadCount) {
  const PointCloud cloud = random_cloud(20'000);
  const Neighbourhood one = Neighbourhood::build(cloud, {}, Executor{}).value();
  const Neighbourhood three = Neighbourhood::build(cloud, {}, Executor::with_threads(3)).value();
  ASSERT_EQ(one.edge_count(), three.edge_count());
  EXPECT_EQ(one.median_cost(), three.median_cost());
  for (std::uint32_t node = 0; node < one.size(); ++node) {
    const auto a = one.edges(node);
    const auto b = three.edges(node);
    EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end(),
                           [](const auto& e, const auto& f) { return e.node == f.node && e.cost == f.cost; }));
  }
}

TEST(Neighbourhood, CanBeCancelledBetweenItsStages) {
  const PointCloud cloud = random_cloud(400);
  std::vector<std::size_t> seen;
  Progress* stop{nullptr};
  Progress progress{[&](std::string_view stage, std::size_t done, std::size_t total) {
    EXPECT_EQ(stage, "graph");
    EXPECT_EQ(total, 3U);
    seen.push_back(done);
    if (stop != nullptr && done == 1) stop->request_cancel();
  }};
  EXPECT_TRUE(Neighbourhood::build(cloud, {}, Executor{}, progress));
  EXPECT_EQ(seen, (std::vector<std::size_t>{0, 1, 2, 3}));
  seen.clear();
  stop = &progress;
  const auto cancelled = Neighbourhood::build(cloud, {}, Executor{}, progress);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, Errc::cancelled);
  EXPECT_EQ(seen, (std::vector<std::size_t>{0, 1}));
}

TEST(Neighbourhood, ABadConfigurationIsAnError) {
  const auto fails = [](const auto& change) {
    NeighbourhoodConfig config;
    change(config);
    const auto graph = Neighbourhood::build(random_cloud(5), config, Executor{});
    return !graph.ok() && graph.error().code == Errc::invalid_argument;
  };
  EXPECT_TRUE(fails([](NeighbourhoodConfig& c) { c.neighbours = 0; }));
  EXPECT_TRUE(fails([](NeighbourhoodConfig& c) { c.neighbours = 65; }));
  EXPECT_TRUE(fails([](NeighbourhoodConfig& c) { c.normal_weight = -1.0; }));
  EXPECT_TRUE(fails([](NeighbourhoodConfig& c) { c.color_weight = std::nan(""); }));
  EXPECT_TRUE(fails([](NeighbourhoodConfig& c) { c.max_path = 0.0; }));
  EXPECT_TRUE(fails([](NeighbourhoodConfig& c) {
    c.position_weight_per_m = 0.0;
    c.normal_weight = 0.0;
    c.color_weight = 0.0;
  }));
}

}  // namespace
}  // namespace saccade
