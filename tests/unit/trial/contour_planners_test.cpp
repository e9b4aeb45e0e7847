// SPDX-License-Identifier: Apache-2.0
// Planners to compare attention with: standard, random-contours and oracle.
#include <gtest/gtest.h>

#include <algorithm>

#include "saccade/explore/baseline_planners.hpp"
#include "saccade/trial/internal/oracle_gain.hpp"
#include "saccade/views/view_gain.hpp"
#include "unit/explore/scanned_clutter.hpp"

namespace saccade {
namespace {

using ContourPlanners = test::ScannedClutter;

TEST_F(ContourPlanners, StandardFindsTheBestOfAllContourViews) {
  SimulatedRunConfig printed = config();
  printed.as_printed = true;  // gains are those of all rays
  const Ranking ranking = ranked(planner("standard", printed), scene(scanned()));
  const std::vector<RankedView> views = ranking.choice()->candidates;
  const std::vector<ContourVoxel> voxels = contour_voxels(scanned(), config().contours, Executor{}).value();
  const std::vector<Pose> poses =
      contour_views(contour_points(voxels, config().voxel_size_m, config().contours)).value();
  EXPECT_EQ(ranking.candidates(), poses.size());
  const std::vector<OrderedView> expected =
      order_views(evaluate_views(scanned(), workspace(), poses, gain(), Executor{})->gains, poses);
  ASSERT_GE(expected.size(), views.size());
  ASSERT_GT(views.size(), 10U);
  for (std::size_t i = 0; i < views.size(); ++i) {
    EXPECT_EQ(views[i].gain, static_cast<double>(expected[i].gain));
    EXPECT_EQ(views[i].T_world_camera.matrix(), expected[i].T_world_camera.matrix());
  }
  // Asked again, it goes on behind those.
  Attempts attempts;
  attempts.add_refused(0, views, Refusal::no_path);
  EXPECT_EQ(ranked(planner("standard", printed), scene(scanned(), &attempts)).best().gain,
            static_cast<double>(expected[views.size()].gain));
}

TEST_F(ContourPlanners, RandomContoursAreAShuffleThatTheSeedDecides) {
  const auto first_of = [](std::uint64_t seed, std::size_t taken) {
    SimulatedRunConfig seeded = config();
    seeded.seed = seed;
    Attempts attempts;
    for (std::size_t i = 0; i < taken; ++i) attempts.add_view(ViewRecord{});
    const Ranking ranking = ranked(planner("random-contours", seeded), scene(scanned(), &attempts));
    EXPECT_EQ(ranking.as_good_as_best(0.0).size(), 1U);  // not by gain
    return ranking.best().T_world_camera.matrix().eval();
  };
  EXPECT_EQ(first_of(1, 0), first_of(1, 0));
  EXPECT_NE(first_of(1, 0), first_of(2, 0));
  EXPECT_NE(first_of(1, 0), first_of(1, 1));
}

TEST_F(ContourPlanners, TheSeedChangesTheViewsOfThoseThatUseItAlone) {
  SimulatedRunConfig coarse = config();
  coarse.contour_views.roll_step_rad = 360_deg;
  coarse.gain_width_px = 16;
  const Planners planners = trial_planners();
  for (const NamedPlanner& named : planners.all()) {
    const auto best_of = [&](std::uint64_t seed) {
      SimulatedRunConfig seeded = coarse;
      seeded.seed = seed;
      seeded.planner.min_gain = 1e-9;
      const Ranking ranking = ranked(planner(named.name, seeded), scene(scanned()));
      EXPECT_FALSE(ranking.empty()) << named.name;
      return ranking.empty() ? Eigen::Matrix4d{} : ranking.best().T_world_camera.matrix().eval();
    };
    EXPECT_EQ(best_of(1) != best_of(2), named.uses_seed) << named.name;
  }
}

/// Baselines choose from the views of standard, by gains of their own.
TEST_F(ContourPlanners, BaselinesRankTheContourViews) {
  SimulatedRunConfig coarse = config();
  coarse.contour_views.roll_step_rad = 360_deg;
  coarse.gain_width_px = 16;
  const std::size_t candidates = ranked(planner("standard", coarse), scene(scanned())).candidates();
  for (const NamedPlanner& baseline : baseline_planners()) {
    coarse.planner.min_gain = baseline.min_gain;
    const Ranking ranking = ranked(planner(baseline.name, coarse), scene(scanned()));
    EXPECT_EQ(ranking.candidates(), candidates) << baseline.name;
    ASSERT_FALSE(ranking.empty()) << baseline.name;
    EXPECT_GT(ranking.best().gain, ranking.as_good_as_best(0.0).back().gain) << baseline.name;
    EXPECT_TRUE(test::falls(ranking.as_good_as_best(0.0)));
    EXPECT_NE(baseline.gain_unit, "");
    EXPECT_FALSE(baseline.needs_truth || baseline.looks_at_regions);
  }
}

TEST_F(ContourPlanners, TheOraclesFirstViewShowsMoreOfTheObjectsThanOthers) {
  const Ranking ranking = ranked(planner("oracle"), scene(scanned()));
  const std::vector<RankedView> views = ranking.choice()->candidates;
  ASSERT_GT(views.size(), 40U);
  EXPECT_TRUE(test::falls(views));
  const auto coverage_after = [](const Pose& pose) {
    TsdfMap map{scanned()};
    SimulatedRunConfig exact = config();
    exact.noise = false;
    SimulatedCamera camera = *simulated_camera(rays(), exact);
    for (int i = 0; i < 3; ++i) {
      const Frame frame = camera.capture(pose, Executor{});
      EXPECT_TRUE(map.integrate(config().camera, frame.depth, pose, Executor{}));
    }
    return measure_map(truth(), map.content(), Executor{}).coverage.value();
  };
  const double best = coverage_after(views.front().T_world_camera);
  const double middle = coverage_after(views[views.size() / 2].T_world_camera);
  EXPECT_GT(best, coverage_after(views.back().T_world_camera));
  EXPECT_GT(best, middle);
}

}  // namespace
}  // namespace saccade
