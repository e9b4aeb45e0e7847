// SPDX-License-Identifier: Apache-2.0
// Surfels that touch and their segments, held to the thesis word by word, for every number of threads.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "saccade/segment/flood_fill.hpp"
#include "saccade/segment/internal/surfel_graph.hpp"
#include "support/effort.hpp"
#include "support/naive_surfels.hpp"

namespace saccade::test {
namespace {

/// Kinds: scattered in a box, on a lattice where many distances are equal to the sum of radii, heaps at few places, and
/// sizes that differ by a factor of a thousand.
PointCloud random_surfels(std::mt19937& random, int kind, std::size_t count) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  };
  const auto whole = [&](int low, int high) { return std::uniform_int_distribution<int>{low, high}(random); };
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d p{uniform(-0.1, 0.1), uniform(-0.1, 0.1), uniform(-0.01, 0.01)};
    double radius_m = uniform(0.004, 0.01);
    if (kind == 1) {
      p = Eigen::Vector3d{whole(-9, 9) * 0.25, whole(-9, 9) * 0.25, whole(-1, 1) * 0.25};
      radius_m = whole(0, 3) * 0.125;
    } else if (kind == 2) {
      p = Eigen::Vector3d{whole(-1, 1) * 0.01, whole(-1, 1) * 0.01, 0.0};
    } else if (kind == 3) {
      radius_m = 0.02 * std::pow(10.0, uniform(-3.0, 0.0));
    }
    cloud.positions_m.push_back(p.cast<float>());
    cloud.radii_m.push_back(static_cast<float>(radius_m));
    cloud.colors.push_back(Eigen::Vector3d{whole(0, 4) / 16.0, 0.0, whole(0, 1) / 16.0}.cast<float>());
    cloud.normals.push_back(Eigen::Vector3d{uniform(-0.3, 0.3), uniform(-0.3, 0.3), 1.0}.normalized().cast<float>());
    if (whole(0, 30) == 0) cloud.normals.back().setZero();
    if (whole(0, 30) == 0) cloud.positions_m.back().x() = std::nanf("");
  }
  return cloud;
}

TEST(SurfelSegments, AreThoseOfTheEquationsForEveryThreadCount) {
  std::mt19937 random{20260};
  const int cases = scaled_cases(80);
  std::size_t compared{0}, segments{0}, edges{0};
  for (int i = 0; i < cases; ++i) {
    const PointCloud cloud = random_surfels(random, i % 4, 300);
    const FloodFillConfig config{1.0, 0.5, 0.02 + 0.04 * (i % 5)};
    const auto alike = [&](std::size_t a, std::size_t b) {
      if (!naive_touch(cloud, a, b)) return false;
      const double colors = (cloud.colors[a].cast<double>() - cloud.colors[b].cast<double>()).norm();
      const bool known = !cloud.normals[a].isZero() && !cloud.normals[b].isZero();
      const double normals = known ? 1.0 - cloud.normals[a].cast<double>().dot(cloud.normals[b].cast<double>()) : 0.0;
      return 1.0 * colors + 0.5 * normals < config.threshold;
    };
    const std::vector<std::uint32_t> expected = naive_components(cloud, alike);
    const std::vector<std::uint32_t> whole =
        naive_components(cloud, [&](std::size_t a, std::size_t b) { return naive_touch(cloud, a, b); });
    for (const std::size_t threads : {1U, 2U, 4U}) {
      const Executor executor = Executor::with_threads(threads);
      const SurfelComponents found = flood_fill(cloud, config, executor).value();
      ASSERT_EQ(found.labels, expected) << "case " << i << ", " << threads << " threads";
      const SurfelGraph graph = SurfelGraph::create(cloud).value();
      const std::vector<std::uint32_t> one(cloud.positions_m.size(), 5);
      ASSERT_EQ(split_unconnected(graph, one, executor).value().labels, whole) << "case " << i;
      compared += found.labels.size();
      segments += found.count;
    }
    const SurfelGraph graph = SurfelGraph::create(cloud).value();
    std::set<std::pair<std::uint32_t, std::uint32_t>> met;
    std::size_t calls{0};
    graph.for_each_edge(Executor{}, [&](std::uint32_t a, std::uint32_t b) {
      met.insert(std::minmax(graph.surfels()[a], graph.surfels()[b]));
      calls += 1;
    });
    for (std::uint32_t a = 0; a < cloud.positions_m.size(); ++a) {
      for (std::uint32_t b = a + 1; b < cloud.positions_m.size(); ++b) {
        ASSERT_EQ(met.count({a, b}) > 0, naive_touch(cloud, a, b)) << "case " << i << ": " << a << ", " << b;
      }
    }
    ASSERT_EQ(calls, met.size()) << "every edge comes once";
    edges += calls;
  }
  EXPECT_EQ(compared, static_cast<std::size_t>(cases) * 3 * 300);
  EXPECT_GT(segments, 10U * static_cast<std::size_t>(cases));
  EXPECT_GT(edges, 1000U * static_cast<std::size_t>(cases));
}

}  // namespace
}  // namespace saccade::test
