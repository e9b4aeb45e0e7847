// SPDX-License-Identifier: Apache-2.0
// Contour voxels against a voxel-by-voxel walk, and those that follow the map against those from scratch, over random
// frames, forgotten and freed regions, workspaces, weights and threads.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <vector>

#include "saccade/views/contours.hpp"
#include "support/effort.hpp"
#include "support/naive_contours.hpp"
#include "support/parallel_backend.hpp"
#include "support/random_map.hpp"

namespace saccade {
namespace {

constexpr int kContourRuns{test::scaled_cases(16)};
constexpr int kContourSteps{4};

std::optional<Box> random_workspace(test::RandomRun& run) {
  if (run.integer(0, 2) == 0) return {};
  const double extent = run.extent();
  const auto corner = [&] { return Eigen::Vector3d::NullaryExpr([&] { return run.uniform(0.1, 0.9) * extent; }); };
  return Box{-corner(), corner()};
}

ContourConfig random_contour_config(test::RandomRun& run) {
  ContourConfig config;
  config.known_weight = static_cast<std::uint16_t>(run.integer(1, 6));
  return config;
}

TEST(ContoursProperty, EqualTheWalkOverAllVoxels) {
  std::size_t voxels{0};
  int compared{0};
  TsdfGrid::Usage kinds;
  for (std::uint32_t seed = 1; seed <= kContourRuns; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::RandomMap random{seed};
    const ContourConfig config = random_contour_config(random.run());
    const std::optional<Box> workspace = random_workspace(random.run());
    for (int step = 0; step < kContourSteps; ++step, ++compared) {
      SCOPED_TRACE("step " + std::to_string(step));
      for (int i = 0; i < 3; ++i) random.step();
      TsdfSnapshot map = random.snapshot();
      map.config.workspace = workspace;
      const std::vector<ContourVoxel> expected = test::NaiveContours{map, config.known_weight}.all();
      for (std::size_t threads = 1; threads <= 4; threads *= 2) {
        const Executor executor = Executor::with_threads(threads, test::kParallelBackend);
        ASSERT_EQ(contour_voxels(map, config, executor).value(), expected) << threads << " threads";
      }
      voxels += expected.size();
      const TsdfGrid::Usage usage = map.grid.usage();
      kinds.constant_free_bricks += usage.constant_free_bricks;
      kinds.free_bricks += usage.free_bricks;
      kinds.dense_bricks += usage.dense_bricks;
    }
  }
  EXPECT_EQ(compared, kContourRuns * kContourSteps);
  EXPECT_GT(voxels, static_cast<std::size_t>(compared) * 100);
  EXPECT_GT(std::min({kinds.constant_free_bricks, kinds.free_bricks, kinds.dense_bricks}),
            static_cast<std::size_t>(compared) * 10);
  std::printf("%d comparisons, %zu contour voxels\n", compared, voxels);
}

TEST(ContoursProperty, ThoseThatFollowTheMapEqualThoseFromScratch) {
  std::size_t voxels{0};
  int compared{0};
  for (std::uint32_t seed = 1; seed <= kContourRuns; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::RandomMap random{1000 + seed};
    const ContourConfig config = random_contour_config(random.run());
    std::optional<Box> workspace = random_workspace(random.run());
    std::uint16_t free_weight = random.snapshot().config.free_weight;
    std::array<LiveContours, 3> followers{LiveContours::create(config).value(), LiveContours::create(config).value(),
                                          LiveContours::create(config).value()};
    for (int step = 0; step < 3 * kContourSteps; ++step, ++compared) {
      SCOPED_TRACE("step " + std::to_string(step));
      random.step();
      if (random.run().integer(0, 9) == 0) workspace = random_workspace(random.run());
      TsdfSnapshot map = random.snapshot();
      if (random.run().integer(0, 19) == 0) map.grid = {};  // a map of which nothing is known, then as before
      map.config.workspace = workspace;
      if (random.run().integer(0, 9) == 0) free_weight = static_cast<std::uint16_t>(random.run().integer(1, 7));
      map.config.free_weight = free_weight;
      const std::vector<ContourVoxel> expected = contour_voxels(map, config, {}).value();
      for (std::size_t i = 0; i < followers.size(); ++i) {
        followers[i].update(map, Executor::with_threads(std::size_t{1} << i, test::kParallelBackend));
        ASSERT_EQ(followers[i].voxels(), expected) << "follower " << i;
      }
      ASSERT_EQ(followers[0].points(), contour_points(expected, map.config.voxel_size_m, config));
      voxels += expected.size();
    }
  }
  EXPECT_EQ(compared, 3 * kContourRuns * kContourSteps);
  EXPECT_GT(voxels, static_cast<std::size_t>(compared) * 100);
  std::printf("%d comparisons, %zu contour voxels\n", compared, voxels);
}

}  // namespace
}  // namespace saccade
