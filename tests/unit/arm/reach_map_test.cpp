// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/reach_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/test_arms.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

/// A wrist arm of about a metre, with limits and a thin body on its last link.
ArmModel arm() {
  constexpr double kRightAngle{0.5 * std::numbers::pi};
  ArmDescription description = test::describe("small", {{1.0, 0.0, 0.3, 0.0, kRightAngle, -2.0, 1.0},
                                                        {1.0, kRightAngle, 0.0, 0.45, 0.0, -1.5, 1.5},
                                                        {1.0, 0.0, 0.0, 0.0, kRightAngle, -2.0, 2.0},
                                                        {1.0, 0.0, 0.4, 0.0, -kRightAngle},
                                                        {1.0, 0.0, 0.0, 0.0, kRightAngle, -2.0, 2.0},
                                                        {1.0, 0.0, 0.08, 0.0, 0.0}});
  description.links.back().bodies.push_back({"hand", Pose::Identity(), BoxBody{{0.1, 0.1, 0.05}}});
  description.links[3].bodies.push_back({"forearm", Pose::Identity(), BoxBody{{0.1, 0.1, 0.3}}});
  return ArmModel::create(description).value();
}

Reachability reachability() { return Reachability::create(ArmCollision::create(arm()).value()).value(); }

/// Free space with a table.
ObstacleMap table() {
  TsdfConfig config;
  config.voxel_size_m = 0.04;
  config.workspace = Box{{-0.1, -0.1, 0.8}, {0.1, 0.1, 1.0}};
  TsdfMap map = TsdfMap::create(config).value();
  EXPECT_TRUE(map.free(*config.workspace).ok());
  ObstacleConfig obstacles;
  obstacles.fixtures.push_back({{0.2, -0.5, -0.1}, {1.0, 0.5, 0.1}});
  return ObstacleMap::create(map.snapshot(), obstacles, {}).value();
}

ReachMapConfig coarse() {
  ReachMapConfig config;
  config.workspace = Box{{0.2, -0.32, 0.0}, {0.75, 0.3, 0.4}};
  config.height_m = 0.15;
  config.step_m = 0.1;
  config.sphere.radii_m = {0.25, 0.4};
  config.sphere.latitude_step_rad = std::numbers::pi / 6.0;
  config.sphere.longitude_step_rad = std::numbers::pi / 4.0;
  config.sphere.roll_step_rad = std::numbers::pi / 2.0;
  return config;
}

TEST(ReachMap, CountsWhatOnePoseAfterTheOtherGives) {
  const Reachability reach = reachability();
  const ObstacleMap obstacles = table();
  const ReachMapConfig config = coarse();
  const ReachMap map = reach_map(reach, reach.arm().middle(), obstacles, config, {}).value();
  ASSERT_EQ(map.columns, 5U);
  ASSERT_EQ(map.rows, 6U);
  ASSERT_EQ(map.points.size(), 30U);
  EXPECT_EQ(map.points_done, 30U);
  EXPECT_EQ(map.poses_per_point, 2U * 4U * 8U * 4U);
  EXPECT_TRUE(map.points.front().p_world.isApprox(Vector3d{0.275, -0.26, 0.15}, 1e-12));
  EXPECT_TRUE(map.points.back().p_world.isApprox(Vector3d{0.675, 0.24, 0.15}, 1e-12));

  ReachCounts all;
  std::vector<ReachCounts> directions(4 * 8);
  std::vector<ReachCounts> radii(2);
  for (const ReachPoint& point : map.points) {
    ReachCounts counts;
    const std::vector<ViewCandidate> views = view_sphere(point.p_world, config.sphere).value();
    for (const ViewCandidate& view : views) {
      const PoseGoals goals = reach.goals(view.T_world_camera, reach.arm().middle(), obstacles);
      EXPECT_EQ(goals.refusal.has_value(), goals.free.empty());
      counts.add(goals.refusal);
      const auto latitude = static_cast<std::size_t>(std::lround(view.latitude_rad / config.sphere.latitude_step_rad));
      const auto longitude =
          static_cast<std::size_t>(std::lround(view.longitude_rad / config.sphere.longitude_step_rad));
      directions[8 * latitude + longitude].add(goals.refusal);
      radii[view.radius_m > 0.3 ? 1 : 0].add(goals.refusal);
    }
    EXPECT_EQ(point.counts, counts) << point.p_world.transpose();
    all += counts;
  }
  EXPECT_EQ(map.total(), all);
  for (const std::size_t part : {all.reachable, all.no_ik, all.outside_limits, all.goal_in_collision}) {
    EXPECT_GT(part, 50U) << "the case asks for every reason";
  }
  ASSERT_EQ(map.directions.size(), directions.size());
  for (std::size_t i = 0; i < directions.size(); ++i) EXPECT_EQ(map.directions[i].counts, directions[i]) << i;
  EXPECT_EQ(map.by_radius, radii);
  const std::vector<ReachDirection> bands = map.by_latitude();
  ASSERT_EQ(bands.size(), 4U);
  EXPECT_NEAR(bands[2].latitude_rad, std::numbers::pi / 3.0, 1e-12);
  EXPECT_EQ(bands[2].counts.poses(), 30U * 2U * 8U * 4U);
  for (const ReachPoint& point : map.points) {
    EXPECT_LE(point.counts.share(), map.points[map.best()].counts.share());
    EXPECT_GE(point.counts.share(), map.points[map.worst()].counts.share());
  }
}

TEST(ReachMap, IsTheSameForEveryThreadCount) {
  const Reachability reach = reachability();
  const ObstacleMap obstacles = table();
  const ReachMap one = reach_map(reach, reach.arm().middle(), obstacles, coarse(), {}).value();
  const ReachMap three = reach_map(reach, reach.arm().middle(), obstacles, coarse(),
                                   Executor::with_threads(3, Executor::Backend::std_thread))
                             .value();
  ASSERT_EQ(one.points.size(), three.points.size());
  for (std::size_t i = 0; i < one.points.size(); ++i) EXPECT_EQ(one.points[i].counts, three.points[i].counts);
}

TEST(ReachMap, KeepsWhatWasDoneWhenItIsCancelled) {
  const Reachability reach = reachability();
  ReachMapConfig config = coarse();
  config.step_m = 0.02;
  Progress* cancelled = nullptr;
  Progress progress{[&cancelled](std::string_view, std::size_t done, std::size_t) {
    if (done > 0) cancelled->request_cancel();
  }};
  cancelled = &progress;
  const ReachMap map = reach_map(reach, reach.arm().middle(), table(), config, {}, progress).value();
  EXPECT_GT(map.points_done, 0U);
  EXPECT_LT(map.points_done, map.points.size());
  EXPECT_EQ(map.points[map.points_done - 1].counts.poses(), map.poses_per_point);
  EXPECT_LT(map.points[map.points_done].counts.poses(), map.poses_per_point);
}

TEST(ReachMap, RefusesGridsThatMakeNoSense) {
  const auto message = [](const auto& change) {
    ReachMapConfig config = coarse();
    change(config);
    const Status status = config.validate();
    return status ? std::string{} : status.error().message;
  };
  EXPECT_EQ(message([](ReachMapConfig&) {}), "");
  EXPECT_EQ(message([](ReachMapConfig& c) { c.step_m = 0.0; }), "the step must be positive");
  EXPECT_EQ(message([](ReachMapConfig& c) { c.step_m = std::nan(""); }), "the step must be positive");
  EXPECT_EQ(message([](ReachMapConfig& c) { c.workspace.max.x() = 0.1; }), "the workspace is empty");
  EXPECT_EQ(message([](ReachMapConfig& c) { c.step_m = 0.6; }),
            "the step is larger than the workspace; choose a smaller one");
  EXPECT_NE(message([](ReachMapConfig& c) { c.step_m = 0.001; }).find("million poses"), std::string::npos);
  EXPECT_NE(message([](ReachMapConfig& c) { c.sphere.radii_m = {-1.0}; }).find("radii"), std::string::npos);
}

}  // namespace
}  // namespace saccade
