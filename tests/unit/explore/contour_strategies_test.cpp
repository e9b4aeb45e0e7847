// SPDX-License-Identifier: Apache-2.0
// What the attention is compared with: standard, random-contours and oracle.
#include "saccade/explore/contour_strategies.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "saccade/explore/oracle_strategy.hpp"
#include "saccade/view/view_order.hpp"
#include "unit/explore/scanned_clutter.hpp"

namespace saccade {
namespace {

using ContourStrategies = test::ScannedClutter;

TEST_F(ContourStrategies, StandardFindsTheBestOfAllContourViews) {
  const StandardStrategy strategy{config().attention.contours, config().contour_views, gain()};
  const Proposals proposals = proposed(strategy, situation(scanned()));
  const std::vector<ContourVoxel> voxels = contour_voxels(scanned(), config().attention.contours, Executor{}).value();
  const std::vector<Pose> poses =
      contour_views(contour_points(voxels, config().voxel_size_m, config().attention.contours)).value();
  EXPECT_EQ(proposals.candidates, poses.size());
  const std::vector<RankedView> ranked =
      order_views(evaluate_views(scanned(), workspace(), poses, gain(), Executor{})->gains, poses);
  ASSERT_GE(ranked.size(), proposals.views.size());
  ASSERT_GT(proposals.views.size(), 10U);
  for (std::size_t i = 0; i < proposals.views.size(); ++i) {
    EXPECT_EQ(proposals.views[i].gain, static_cast<double>(ranked[i].gain));
    EXPECT_EQ(proposals.views[i].T_world_camera.matrix(), ranked[i].T_world_camera.matrix());
  }
  // Asked again, it goes on behind those.
  Situation again = situation(scanned());
  again.attempted = [&](const Pose& pose) {
    return std::any_of(proposals.views.begin(), proposals.views.end(),
                       [&](const Proposal& view) { return view.T_world_camera.matrix() == pose.matrix(); });
  };
  EXPECT_EQ(proposed(strategy, again).views.front().gain, static_cast<double>(ranked[proposals.views.size()].gain));
}

TEST_F(ContourStrategies, RandomContoursAreAShuffleThatTheSeedDecides) {
  const auto first_of = [](std::uint64_t seed, std::size_t taken) {
    const RandomContourStrategy strategy{config().attention.contours, config().contour_views, ray_gain(gain()), seed};
    Situation asked = situation(scanned());
    asked.views_of_region = taken;
    const Proposals proposals = proposed(strategy, asked);
    EXPECT_FALSE(proposals.by_gain);
    return proposals.views.front().T_world_camera.matrix().eval();
  };
  EXPECT_EQ(first_of(1, 0), first_of(1, 0));
  EXPECT_NE(first_of(1, 0), first_of(2, 0));
  EXPECT_NE(first_of(1, 0), first_of(1, 1));
}

TEST_F(ContourStrategies, TheOraclesFirstViewShowsMoreOfTheObjectsThanOthers) {
  const OracleStrategy oracle{truth(), config().camera, config().exploration.oscillation_rad,
                              config().attention.contours, config().contour_views};
  const Proposals proposals = proposed(oracle, situation(scanned()));
  ASSERT_GT(proposals.views.size(), 40U);
  EXPECT_TRUE(falls(proposals.views));
  const auto coverage_after = [](const Pose& pose) {
    TsdfMap map{scanned()};
    SimulatedRunConfig exact = config();
    exact.noise = false;
    SimulatedCamera camera = *simulated_camera(rays(), exact);
    for (int i = 0; i < 3; ++i) {
      const Frame frame = camera.capture(pose, Executor{});
      EXPECT_TRUE(map.integrate(config().camera, frame.depth, pose, Executor{}));
    }
    return measure_map(truth(), map.content(), Executor{}).metrics.coverage;
  };
  const double best = coverage_after(proposals.views.front().T_world_camera);
  const double middle = coverage_after(proposals.views[proposals.views.size() / 2].T_world_camera);
  EXPECT_GT(best, coverage_after(proposals.views.back().T_world_camera));
  EXPECT_GT(best, middle);
}

}  // namespace
}  // namespace saccade
