// SPDX-License-Identifier: Apache-2.0
// Saliency by the voxels of LiveSegments stands for saliency by all points: how far they are apart.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "analytic_map.hpp"
#include "saccade/attention/saliency.hpp"
#include "saccade/segment/live_segments.hpp"

namespace saccade {
namespace {

std::vector<SegmentMeasures> measured(std::span<const Eigen::Vector3f> positions_m,
                                      std::span<const std::uint32_t> labels, std::size_t segments) {
  return measure_segments(SegmentedPoints::create(positions_m, labels, segments).value(), {}, Executor{}).value();
}

TEST(SaliencyParity, VoxelsStandForPoints) {
  TsdfConfig config;
  config.voxel_size_m = 0.004;
  const TsdfSnapshot map = test::map_of(config, {{-70, -70, -16}, {70, 70, 50}}, [](const Eigen::Vector3d& p) {
    return std::min({p.z() - 0.002, test::sphere_sdf(p, {0.12, 0.0, 0.05}, 0.06),
                     test::box_sdf(p, {-0.1, 0.0, 0.06}, {0.05, 0.07, 0.06}),
                     test::box_sdf(p, {0.02, 0.15, 0.03}, {0.03, 0.02, 0.03})});
  });
  LiveSegments live = LiveSegments::create().value();
  static_cast<void>(live.update(map, Executor{}));
  const MapSegments points = live.segments(Executor{});
  const VoxelSegments voxels = live.voxels(Executor{});
  const auto by_points = measured(points.points.positions_m, points.segments.labels, points.segments.segments);
  const auto by_voxels = measured(voxels.positions_m, voxels.labels, voxels.segments);
  ASSERT_EQ(by_points.size(), by_voxels.size());
  double roundness{0.0}, isolation{0.0}, objectness{0.0};
  std::size_t compared{0};
  std::vector<std::pair<double, std::size_t>> order_by_points, order_by_voxels;
  for (std::size_t s = 0; s < by_points.size(); ++s) {
    if (by_points[s].points < 500) continue;
    ++compared;
    roundness = std::max(roundness, std::abs(by_voxels[s].roundness - by_points[s].roundness));
    isolation = std::max(isolation, std::abs(by_voxels[s].isolation - by_points[s].isolation));
    objectness = std::max(objectness, std::abs(by_voxels[s].isolation * by_voxels[s].roundness -
                                               by_points[s].isolation * by_points[s].roundness));
    order_by_points.emplace_back(by_points[s].isolation * by_points[s].roundness, s);
    order_by_voxels.emplace_back(by_voxels[s].isolation * by_voxels[s].roundness, s);
  }
  std::printf("%zu segments, apart by at most: roundness %.3f, isolation %.3f, objectness %.3f\n", compared, roundness,
              isolation, objectness);
  EXPECT_GE(compared, 4U);
  EXPECT_LT(roundness, 0.05);
  EXPECT_LT(isolation, 0.05);
  EXPECT_LT(objectness, 0.1);
  std::sort(order_by_points.begin(), order_by_points.end());
  std::sort(order_by_voxels.begin(), order_by_voxels.end());
  for (std::size_t i = 0; i < compared; ++i) EXPECT_EQ(order_by_points[i].second, order_by_voxels[i].second);
}

}  // namespace
}  // namespace saccade
