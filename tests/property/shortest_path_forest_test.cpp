// SPDX-License-Identifier: Apache-2.0
// The four propositions of thesis §4.2.1 in one: whatever was added and removed, in whatever order, every point belongs
// to the root that its definition says.
#include "saccade/annotate/shortest_path_forest.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <map>
#include <set>

#include "support/effort.hpp"
#include "support/naive_forest.hpp"

namespace saccade {
namespace {

/// Points on a coarse grid, so that many paths are equally long and points coincide.
PointCloud random_cloud(bool with_colors, bool with_normals) {
  PointCloud cloud;
  const auto count = *rc::gen::inRange<std::size_t>(1, 120);
  for (std::size_t i = 0; i < count; ++i) {
    const auto coordinate = [] { return 0.05F * static_cast<float>(*rc::gen::inRange(0, 6)); };
    cloud.positions_m.emplace_back(coordinate(), coordinate(), 0.0F);
    if (with_colors) cloud.colors.emplace_back(*rc::gen::element(0.0F, 0.5F, 1.0F), 0.0F, 0.0F);
    if (with_normals) cloud.normals.push_back(*rc::gen::element(Eigen::Vector3f::UnitX(), Eigen::Vector3f::UnitZ()));
  }
  return cloud;
}

void expect_as_defined(const ShortestPathForest& forest, const std::map<std::uint32_t, Root>& roots) {
  std::vector<Root> expected;
  for (const auto& [point, root] : roots) expected.push_back(root);
  const Neighbourhood& graph = forest.neighbourhood();
  const test::NaiveForest naive = test::naive_forest(graph, expected);
  for (std::uint32_t point = 0; point < graph.size(); ++point) {
    RC_ASSERT(forest.root_of(point).has_value() == naive[point].has_value());
    if (!naive[point]) continue;
    RC_ASSERT(*forest.root_of(point) == naive[point]->second);
    RC_ASSERT(forest.path_length(point) ==
              static_cast<double>(naive[point]->first) * (graph.config().max_path / kPathUnits));
  }
}

TEST(ShortestPathForestProperty, AnySequenceOfChangesEqualsARebuild) {
  int cases{0};
  rc::check([&] {
    NeighbourhoodConfig config;
    config.neighbours = *rc::gen::inRange(1, 12);
    config.max_path = *rc::gen::element(0.1, 0.5, 1.0, 5.0);
    config.normal_weight = *rc::gen::element(0.0, 0.5);
    const PointCloud cloud = random_cloud(*rc::gen::arbitrary<bool>(), *rc::gen::arbitrary<bool>());
    const auto graph = std::make_shared<const Neighbourhood>(Neighbourhood::build(cloud, config, Executor{}).value());
    ShortestPathForest forest{graph};
    std::map<std::uint32_t, Root> roots;
    const int changes = *rc::gen::inRange(1, 25);
    for (int i = 0; i < changes; ++i) {
      const auto point = *rc::gen::inRange<std::uint32_t>(0, static_cast<std::uint32_t>(graph->size()));
      std::vector<std::optional<std::uint32_t>> before;
      for (std::uint32_t p = 0; p < graph->size(); ++p) before.push_back(forest.root_of(p));
      if (roots.contains(point)) {
        forest.remove(point);
        roots.erase(point);
      } else {
        const Root root{point, config.max_path * *rc::gen::element(0.0, 0.0, 0.0, 0.25, 0.75)};
        forest.add(root);
        roots[point] = root;
      }
      expect_as_defined(forest, roots);
      const std::set<std::uint32_t> touched{forest.touched().begin(), forest.touched().end()};
      for (std::uint32_t p = 0; p < graph->size(); ++p) {
        RC_ASSERT(before[p] == forest.root_of(p) || touched.contains(p));
      }
    }
    std::vector<Root> all = forest.roots();
    RC_ASSERT(all.size() == roots.size());
    for (const Root& root : all) RC_ASSERT(roots.at(root.point) == root);
    ShortestPathForest anew{graph};
    anew.rebuild(all);
    expect_as_defined(anew, roots);
    ++cases;
  });
  EXPECT_GE(cases, 100);
}

}  // namespace
}  // namespace saccade
