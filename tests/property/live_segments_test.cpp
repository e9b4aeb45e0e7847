// SPDX-License-Identifier: Apache-2.0
// Segments that follow the map against segments from scratch, over random frames, forgotten and freed regions, threads.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "analytic_map.hpp"
#include "saccade/segment/live_segments.hpp"
#include "support/effort.hpp"
#include "support/parallel_backend.hpp"
#include "support/random_map.hpp"

namespace saccade {
namespace {

constexpr int kNoiseRuns{test::scaled_cases(8)};
constexpr int kNoiseSteps{6};
constexpr int kTableRuns{test::scaled_cases(30)};
constexpr int kTableSteps{8};

void expect_same_segments(const MapSegments& actual, const MapSegments& expected) {
  EXPECT_EQ(actual.points.positions_m, expected.points.positions_m);
  EXPECT_EQ(actual.points.normals, expected.points.normals);
  EXPECT_EQ(actual.points.colors, expected.points.colors);
  EXPECT_EQ(actual.supervoxels.labels, expected.supervoxels.labels);
  EXPECT_EQ(actual.supervoxels.edges, expected.supervoxels.edges);
  EXPECT_EQ(actual.supervoxels.voxels, expected.supervoxels.voxels);
  ASSERT_EQ(actual.supervoxels.supervoxels.size(), expected.supervoxels.supervoxels.size());
  for (std::size_t i = 0; i < expected.supervoxels.supervoxels.size(); ++i) {
    const Supervoxel& a = actual.supervoxels.supervoxels[i];
    const Supervoxel& b = expected.supervoxels.supervoxels[i];
    ASSERT_TRUE(a.centroid_m == b.centroid_m && a.normal == b.normal && a.color == b.color && a.voxels == b.voxels &&
                a.points == b.points)
        << i;
  }
  EXPECT_EQ(actual.segments.labels, expected.segments.labels);
  EXPECT_EQ(actual.segments.segment_of, expected.segments.segment_of);
  EXPECT_EQ(actual.segments.convex, expected.segments.convex);
  EXPECT_EQ(actual.segments.segments, expected.segments.segments);
}

MapSegmentsConfig random_config(test::RandomRun& run, double map_voxel_size_m, double most_seed_share) {
  MapSegmentsConfig config;
  config.voxel_size_m = map_voxel_size_m * (1 << run.integer(0, 2));
  config.color_weight = run.integer(0, 1);
  config.min_seed_share = run.uniform(0.6 * most_seed_share, most_seed_share);
  config.min_weight = static_cast<std::uint16_t>(run.integer(1, 3));
  config.lccp.extended_convexity = run.integer(0, 3) == 0;
  return config;
}

/// Follows a map with 1, 2 and 4 threads.
class Followers {
 public:
  explicit Followers(const MapSegmentsConfig& config)
      : config_{config},
        live_{LiveSegments::create(config).value(), LiveSegments::create(config).value(),
              LiveSegments::create(config).value()} {}

  /// @return the number of points.
  std::size_t expect_from_scratch(const TsdfSnapshot& map) {
    const MapSegments expected = segment_map(map, {}, config_).value();
    for (std::size_t i = 0; i < live_.size(); ++i) {
      const Executor executor = Executor::with_threads(std::size_t{1} << i, test::kParallelBackend);
      const MapSegmentsUpdate update = live_[i].update(map, executor);
      labelled_ += i == 0 ? update.voxels_labelled : 0;
      expect_same_segments(live_[i].segments(executor), expected);
      EXPECT_EQ(live_[i].segment_count(), expected.segments.segments);
    }
    voxels_ += expected.supervoxels.voxels;
    return expected.points.positions_m.size();
  }
  /// Returns the share of the voxels that were labelled anew.
  [[nodiscard]] double labelled_share() const { return static_cast<double>(labelled_) / static_cast<double>(voxels_); }

 private:
  MapSegmentsConfig config_;
  std::array<LiveSegments, 3> live_;
  std::size_t labelled_{0};
  std::size_t voxels_{0};
};

TEST(LiveSegmentsProperty, EqualSegmentsFromScratchAfterRandomFrames) {
  std::size_t points{0};
  int compared{0};
  for (std::uint32_t seed = 1; seed <= kNoiseRuns; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::RandomMap random{seed};
    Followers followers{random_config(random.run(), random.run().config().voxel_size_m, 0.5)};
    for (int step = 0; step < kNoiseSteps; ++step, ++compared) {
      SCOPED_TRACE("step " + std::to_string(step));
      random.step();
      points += followers.expect_from_scratch(random.snapshot());
      if (testing::Test::HasFailure()) return;
    }
  }
  EXPECT_EQ(compared, kNoiseRuns * kNoiseSteps);
  EXPECT_GT(points, static_cast<std::size_t>(compared) * 300);
  std::printf("%d comparisons, %zu points\n", compared, points);
}

/// Smooth surfaces with seeds far into them; small places of it change, are forgotten, and come back.
void expect_equal_segments_of_changing_tables(int runs) {
  TsdfConfig config;
  config.voxel_size_m = 0.006;
  const auto table = [](const Eigen::Vector3d& p) {
    const double things =
        std::min({test::sphere_sdf(p, {0.1, 0.05, 0.03}, 0.06), test::box_sdf(p, {-0.1, 0.0, 0.05}, {0.05, 0.08, 0.05}),
                  test::box_sdf(p, {0.0, -0.15, 0.01}, {0.1, 0.05, 0.02})});
    return std::min(p.z() - 0.004, things);
  };
  const IndexBox box{{-48, -48, -16}, {48, 48, 32}};
  std::size_t points{0};
  int compared{0};
  double share{0.0};
  for (std::uint32_t seed = 1; seed <= static_cast<std::uint32_t>(runs); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::RandomRun run{seed};
    const TsdfSnapshot whole = test::map_of(config, box, table, seed % 2 == 0);
    MapSegmentsConfig wanted = random_config(run, config.voxel_size_m, 1.5);  // few seeds, which reach far
    wanted.voxel_size_m = config.voxel_size_m * (seed % 4 == 3 ? 2.0 : 1.0);
    wanted.lccp.min_supervoxels = static_cast<std::size_t>(run.integer(0, 3));
    if (seed % 3 == 0) wanted.within = Box{{-0.2, -0.28, -0.05}, {0.15, 0.3, 0.08}};
    Followers followers{wanted};
    TsdfMap map{whole};
    points += followers.expect_from_scratch(map.snapshot());
    for (int step = 0; step < kTableSteps; ++step, ++compared) {
      SCOPED_TRACE("step " + std::to_string(step));
      const Sphere place{{run.uniform(-0.25, 0.25), run.uniform(-0.25, 0.25), run.uniform(-0.02, 0.1)},
                         run.uniform(0.005, 0.06)};
      const int action = run.integer(0, 4);
      if (action == 0) map = TsdfMap{whole};
      if (action == 1 || action == 2) {
        ASSERT_TRUE(map.forget(place).ok());
      }
      if (action == 3) {
        ASSERT_TRUE(map.free(place).ok());
      }
      if (action == 4) {  // a bump
        map = TsdfMap{test::map_of(config, box, [&](const Eigen::Vector3d& p) {
          return std::min(table(p), test::sphere_sdf(p, place.center, place.radius_m));
        })};
      }
      points += followers.expect_from_scratch(map.snapshot());
      if (testing::Test::HasFailure()) return;
    }
    share += followers.labelled_share() / runs;
  }
  EXPECT_EQ(compared, runs * kTableSteps);
  EXPECT_GT(points, static_cast<std::size_t>(compared) * 2000);
  EXPECT_LT(share, 0.7);  // what did not change is kept
  std::printf("%d comparisons, %zu points, %.2f of them labelled\n", compared, points, share);
}

TEST(LiveSegmentsProperty, EqualSegmentsFromScratchWherePlacesOfATableChange) {
  expect_equal_segments_of_changing_tables((kTableRuns + 1) / 2);
}
TEST(LiveSegmentsPropertyEvidence, EqualSegmentsFromScratchWherePlacesOfATableChange) {
  expect_equal_segments_of_changing_tables(kTableRuns);
}

}  // namespace
}  // namespace saccade
