// SPDX-License-Identifier: Apache-2.0
// Regions of wrong labels and their centres against their definition, on random clouds with random labels.
#include "saccade/annotate/annotation_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <random>

#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr int kErrorRuns{test::scaled_cases(300)};

/// Steps from points without which a region would not end; as many as there are points: from none.
std::vector<std::size_t> naive_depths(const Neighbourhood& graph, const std::vector<std::uint8_t>& ends,
                                      const ErrorRegion& region) {
  std::vector<std::size_t> depths(graph.size(), 0);
  for (const std::uint32_t point : region.points) depths[point] = graph.size();
  for (bool changed = true; changed;) {
    changed = false;
    for (const std::uint32_t point : region.points) {
      std::size_t depth = ends[point] != 0 ? 1 : graph.size();
      for (const Neighbourhood::Edge& edge : graph.edges(graph.node_of(point))) {
        depth = std::min(depth, depths[graph.point_of(edge.node)] + 1);
      }
      changed = changed || depth < depths[point];
      depths[point] = std::min(depth, depths[point]);
    }
  }
  return depths;
}

TEST(AnnotationErrorProperty, RegionsPartTheErrorsAndCentresAreDeepest) {
  std::size_t regions_seen{0}, deep{0};
  for (std::uint32_t seed = 1; seed <= kErrorRuns; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 rng{seed};
    const auto integer = [&](int lo, int hi) { return std::uniform_int_distribution<int>{lo, hi}(rng); };
    PointCloud cloud;
    std::vector<std::uint32_t> truth, labels;
    const int count = integer(1, 400);
    const int truths = integer(1, 3);
    for (int i = 0; i < count; ++i) {
      cloud.positions_m.emplace_back(0.01F * static_cast<float>(integer(0, 20)),
                                     0.01F * static_cast<float>(integer(0, 20)), 0.0F);
      if (integer(0, 60) == 0) cloud.positions_m.back().x() = std::numeric_limits<float>::infinity();
      truth.push_back(static_cast<std::uint32_t>(cloud.positions_m.back().y() > 0.1F ? truths : integer(0, 20) / 20));
      labels.push_back(integer(0, 15) == 0 ? truth.back() : static_cast<std::uint32_t>(integer(0, 1)));
    }
    NeighbourhoodConfig config;
    config.neighbours = integer(3, 10);
    config.max_path = integer(0, 1) == 0 ? 1.0 : 0.015;
    const Neighbourhood graph = Neighbourhood::build(cloud, config, Executor{}).value();
    std::vector<std::uint8_t> ends(static_cast<std::size_t>(count), 0);
    if (integer(0, 1) == 0) ends = cloud_ends(graph, cloud.positions_m, {});

    const std::vector<ErrorRegion> regions = error_regions(graph, labels, truth).value();
    std::vector<std::size_t> region_of(truth.size(), regions.size());
    std::size_t in_regions{0};
    for (std::size_t i = 0; i < regions.size(); ++i) {
      ASSERT_TRUE(i == 0 || regions[i].points.size() <= regions[i - 1].points.size());
      ASSERT_TRUE(std::is_sorted(regions[i].points.begin(), regions[i].points.end()));
      in_regions += regions[i].points.size();
      for (const std::uint32_t point : regions[i].points) {
        region_of[point] = i;
        ASSERT_EQ(truth[point], regions[i].truth);
        ASSERT_NE(truth[point], labels[point]);
      }
    }
    ASSERT_EQ(in_regions, score_annotation(labels, truth).value().wrong);
    for (std::uint32_t point = 0; point < truth.size(); ++point) {
      for (const Neighbourhood::Edge& edge : graph.edges(graph.node_of(point))) {
        const std::uint32_t other = graph.point_of(edge.node);
        const bool both_wrong = region_of[point] < regions.size() && region_of[other] < regions.size();
        if (!both_wrong || truth[point] != truth[other] || edge.cost >= kPathUnits) continue;
        ASSERT_EQ(region_of[point], region_of[other]);
      }
    }
    for (const ErrorRegion& region : regions) {
      const std::vector<std::size_t> depths = naive_depths(graph, ends, region);
      std::uint32_t deepest = region.points.front();
      std::size_t depth{0};
      for (const std::uint32_t point : region.points) {
        if (depths[point] <= depth || depths[point] >= graph.size()) continue;
        depth = depths[point];
        deepest = point;
      }
      ASSERT_EQ(region_centre(graph, ends, region), deepest);
      deep += depth > 2 ? 1 : 0;
      regions_seen += 1;
    }
  }
  EXPECT_GT(regions_seen, static_cast<std::size_t>(kErrorRuns));
  EXPECT_GT(deep, static_cast<std::size_t>(kErrorRuns) / 10);
  std::printf("%d clouds, %zu regions, %zu of them deep\n", kErrorRuns, regions_seen, deep);
}

}  // namespace
}  // namespace saccade
