// SPDX-License-Identifier: Apache-2.0
// Segments of maps whose things are known. That they follow the map: tests/property/live_segments_test.cpp.
#include "saccade/segment/live_segments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "analytic_map.hpp"
#include "saccade/segment/overlap.hpp"
#include "saccade/segment/surface_points.hpp"

namespace saccade {
namespace {

constexpr double kMapVoxel_m{0.005};
constexpr double kBall_m{0.06};

TsdfConfig fine() {
  TsdfConfig config;
  config.voxel_size_m = kMapVoxel_m;
  return config;
}

double ball_sdf(const Eigen::Vector3d& p) { return test::sphere_sdf(p, {0.12, 0.0, 0.05}, kBall_m); }
double block_sdf(const Eigen::Vector3d& p) { return test::box_sdf(p, {-0.1, 0.0, 0.06}, {0.05, 0.07, 0.06}); }

/// A ball and a block on a table.
TsdfSnapshot table_with_things() {
  return test::map_of(fine(), {{-56, -56, -16}, {56, 56, 40}}, [](const Eigen::Vector3d& p) {
    return std::min({p.z() - 0.002, ball_sdf(p), block_sdf(p)});
  });
}

MapSegmentsConfig with_voxels(double size_m) {
  MapSegmentsConfig config;
  config.voxel_size_m = size_m;
  return config;
}

/// Every point has a supervoxel and a segment, and each of these has points.
void expect_sound_segments(const MapSegments& found) {
  const std::size_t points = found.points.positions_m.size();
  ASSERT_EQ(found.supervoxels.labels.size(), points);
  ASSERT_EQ(found.segments.labels.size(), points);
  std::vector<std::uint32_t> counts(found.supervoxels.supervoxels.size(), 0);
  std::set<std::uint32_t> segments;
  std::vector<Eigen::Vector3d> sums(counts.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < points; ++i) {
    const std::uint32_t supervoxel = found.supervoxels.labels[i];
    ASSERT_LT(supervoxel, counts.size());
    counts[supervoxel] += 1;
    sums[supervoxel] += found.points.positions_m[i].cast<double>();
    ASSERT_EQ(found.segments.labels[i], found.segments.segment_of[supervoxel]);
    segments.insert(found.segments.labels[i]);
  }
  std::size_t voxels{0};
  for (std::size_t s = 0; s < counts.size(); ++s) {
    const Supervoxel& supervoxel = found.supervoxels.supervoxels[s];
    EXPECT_EQ(supervoxel.points, counts[s]);
    EXPECT_GT(counts[s], 0U);
    EXPECT_NEAR(supervoxel.normal.norm(), 1.0F, 1e-5F);
    EXPECT_LT((sums[s] / counts[s] - supervoxel.centroid_m.cast<double>()).norm(),
              2.0 * found.supervoxels.voxel_size_m);
    voxels += supervoxel.voxels;
  }
  EXPECT_EQ(voxels, found.supervoxels.voxels);
  EXPECT_EQ(segments.size(), found.segments.segments);
  EXPECT_TRUE(std::is_sorted(found.supervoxels.edges.begin(), found.supervoxels.edges.end()));
  EXPECT_EQ(std::set(found.supervoxels.edges.begin(), found.supervoxels.edges.end()).size(),
            found.supervoxels.edges.size());
}

TEST(SegmentMap, LeavesOutTheSurfaceAwayFromABox) {
  const TsdfSnapshot map = table_with_things();
  MapSegmentsConfig around_ball = with_voxels(kMapVoxel_m);
  around_ball.within = Box{{0.06, -0.06, -0.02}, {0.2, 0.06, 0.12}};
  const MapSegments all = segment_map(map, Executor{}, with_voxels(kMapVoxel_m)).value();
  const MapSegments some = segment_map(map, Executor{}, around_ball).value();
  expect_sound_segments(some);
  // Whole blocks of 8³ voxels; all of the surface in the box is there.
  const auto in_box = [&](const MapSegments& found, double margin_m) {
    const Box box{around_ball.within->min.array() - margin_m, around_ball.within->max.array() + margin_m};
    return std::count_if(found.points.positions_m.begin(), found.points.positions_m.end(),
                         [&](const Eigen::Vector3f& p) { return contains(box, p.cast<double>()); });
  };
  EXPECT_EQ(in_box(some, 0.0), in_box(all, 0.0));
  EXPECT_EQ(in_box(some, 9.0 * kMapVoxel_m), std::ssize(some.points.positions_m));
  EXPECT_LT(some.points.positions_m.size(), all.points.positions_m.size() / 2);
  around_ball.within->max.x() = -1.0;
  EXPECT_FALSE(segment_map(map, Executor{}, around_ball));
}

TEST(LiveSegments, KeepThingsOnATableApart) {
  const TsdfSnapshot map = table_with_things();
  for (const double size_m : {0.005, 0.01}) {
    const MapSegments found = segment_map(map, Executor::with_threads(2), with_voxels(size_m)).value();
    ASSERT_NO_FATAL_FAILURE(expect_sound_segments(found));
    EXPECT_DOUBLE_EQ(found.supervoxels.voxel_size_m, size_m);
    std::vector<std::uint32_t> things;
    for (const Eigen::Vector3f& p : found.points.positions_m) {
      const Eigen::Vector3d q = p.cast<double>();
      things.push_back(ball_sdf(q) < 0.002 ? 1 : block_sdf(q) < 0.002 ? 2 : 0);
    }
    const SegmentOverlap overlap = score_segments(found.segments.labels, things).value();
    EXPECT_EQ(overlap.objects, 3U);
    EXPECT_GT(overlap.weighted_overlap, 0.95);
    EXPECT_GT(score_segments(found.segments.labels, things, 1).value().weighted_overlap, 0.85);
  }
}

TEST(LiveSegments, PointsAreThoseOfTheSurface) {
  const TsdfSnapshot map = table_with_things();
  const auto sorted = [](const std::vector<Eigen::Vector3f>& points) {
    std::vector<std::array<float, 3>> made;
    for (const Eigen::Vector3f& p : points) made.push_back({p.x(), p.y(), p.z()});
    std::sort(made.begin(), made.end());
    return made;
  };
  const auto expected = sorted(surface_points(map, {}).positions_m);
  for (const double size_m : {0.005, 0.01, 0.02, 0.04}) {
    const MapSegments found = segment_map(map, {}, with_voxels(size_m)).value();
    ASSERT_NO_FATAL_FAILURE(expect_sound_segments(found));
    EXPECT_EQ(sorted(found.points.positions_m), expected);
    EXPECT_NEAR(found.supervoxels.voxel_size_m, size_m, 1e-12);
  }
}

TEST(LiveSegments, VoxelsStandForTheirPoints) {
  const TsdfSnapshot map = table_with_things();
  for (const double size_m : {kMapVoxel_m, 4.0 * kMapVoxel_m}) {
    LiveSegments live = LiveSegments::create(with_voxels(size_m)).value();
    static_cast<void>(live.update(map, Executor{}));
    const MapSegments of_points = live.segments(Executor{});
    const VoxelSegments of_voxels = live.voxels(Executor::with_threads(3));
    ASSERT_EQ(of_voxels.positions_m.size(), of_points.supervoxels.voxels);
    ASSERT_EQ(of_voxels.labels.size(), of_points.supervoxels.voxels);
    ASSERT_EQ(of_voxels.segments, of_points.segments.segments);
    std::vector<std::size_t> expected(of_voxels.segments, 0);
    for (std::size_t s = 0; s < of_points.supervoxels.supervoxels.size(); ++s) {
      expected[of_points.segments.segment_of[s]] += of_points.supervoxels.supervoxels[s].voxels;
    }
    std::vector<std::size_t> counted(of_voxels.segments, 0);
    for (const std::uint32_t label : of_voxels.labels) counted.at(label) += 1;
    EXPECT_EQ(counted, expected);

    // Both go by blocks, and by voxels within: each voxel is the mean of the next points.
    std::size_t next{0};
    for (std::size_t v = 0; v < of_voxels.positions_m.size(); ++v) {
      Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
      const std::size_t first{next};
      const auto is_mean = [&] {
        const auto points = static_cast<double>(next - first);
        return next > first && (sum_m / points - of_voxels.positions_m[v].cast<double>()).norm() < 1e-6;
      };
      while (!is_mean()) {
        ASSERT_LT(next, of_points.points.positions_m.size());
        ASSERT_EQ(of_points.segments.labels[next], of_voxels.labels[v]);
        sum_m += of_points.points.positions_m[next++].cast<double>();
      }
    }
    EXPECT_EQ(next, of_points.points.positions_m.size());
  }
}

TEST(LiveSegments, ABallInTheAirIsOne) {
  const TsdfSnapshot map = test::map_of(fine(), {{-8, -24, -8}, {56, 24, 32}}, ball_sdf, true);
  const MapSegments found = segment_map(map, {}, with_voxels(kMapVoxel_m)).value();
  ASSERT_NO_FATAL_FAILURE(expect_sound_segments(found));
  EXPECT_EQ(found.segments.segments, 1U);
  EXPECT_GT(found.supervoxels.supervoxels.size(), 30U);
  ASSERT_EQ(found.points.colors.size(), found.points.positions_m.size());
  for (const Supervoxel& supervoxel : found.supervoxels.supervoxels) {
    EXPECT_LT((255.0F * supervoxel.color - Eigen::Vector3f{200.0F, 100.0F, 50.0F}).norm(), 1e-2F);
  }
}

TEST(LiveSegments, APlaneIsOne) {
  const TsdfSnapshot map = test::map_of(fine(), {{-40, -40, -8}, {40, 40, 8}},
                                        [](const Eigen::Vector3d& p) { return p.z() - 0.1 * p.x() - 0.001; });
  const MapSegments found = segment_map(map, {}, with_voxels(kMapVoxel_m)).value();
  ASSERT_NO_FATAL_FAILURE(expect_sound_segments(found));
  EXPECT_EQ(found.segments.segments, 1U);
}

TEST(LiveSegments, OfNothingAreNone) {
  const MapSegments found = segment_map({}, {}).value();
  EXPECT_TRUE(found.points.positions_m.empty());
  EXPECT_EQ(found.segments.segments, 0U);
  EXPECT_TRUE(found.supervoxels.edges.empty());
}

TEST(LiveSegments, AreGoneWhenTheMapForgets) {
  LiveSegments live = LiveSegments::create(with_voxels(kMapVoxel_m)).value();
  TsdfMap map{table_with_things()};
  static_cast<void>(live.update(map.snapshot(), {}));
  EXPECT_GT(live.segment_count(), 2U);
  const MapSegmentsUpdate nothing = live.update(map.snapshot(), {});
  EXPECT_EQ(nothing.bricks_changed + nothing.voxels_changed + nothing.voxels_labelled, 0U);
  EXPECT_GT(live.segment_count(), 2U);
  ASSERT_TRUE(map.forget(Box{Eigen::Vector3d::Constant(-1.0), Eigen::Vector3d::Constant(1.0)}).ok());
  static_cast<void>(live.update(map.snapshot(), {}));
  EXPECT_EQ(live.segment_count(), 0U);
  EXPECT_TRUE(live.segments({}).points.positions_m.empty());
}

TEST(LiveSegments, ASmallChangeIsASmallUpdate) {
  LiveSegments live = LiveSegments::create(with_voxels(kMapVoxel_m)).value();
  TsdfMap map{table_with_things()};
  const MapSegmentsUpdate all = live.update(map.snapshot(), {});
  ASSERT_TRUE(map.forget(Sphere{{-0.2, -0.2, 0.0}, 0.02}).ok());
  const MapSegmentsUpdate one = live.update(map.snapshot(), {});
  EXPECT_GT(one.voxels_changed, 0U);
  EXPECT_LT(one.voxels_changed, all.voxels_changed / 20);
  EXPECT_LT(one.voxels_labelled, all.voxels_labelled / 4);
}

TEST(LiveSegments, BadConfigsAreRefused) {
  for (const double bad :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(LiveSegments::create(with_voxels(bad)).error().code, Errc::invalid_argument);
  }
  MapSegmentsConfig config;
  config.spatial_weight = config.normal_weight = 0.0;
  EXPECT_EQ(segment_map({}, {}, config).error().code, Errc::invalid_argument);
  config = {};
  config.lccp.smoothness = -1.0;
  EXPECT_EQ(segment_map({}, {}, config).error().code, Errc::invalid_argument);
}

}  // namespace
}  // namespace saccade
