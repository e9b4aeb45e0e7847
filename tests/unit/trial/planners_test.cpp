// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/planners.hpp"

#include <gtest/gtest.h>

#include "saccade/scene/scene.hpp"
#include "saccade/trial/simulated_run.hpp"

namespace saccade {
namespace {

TEST(Planners, AreKnownByTheirNamesAndReplacedByOnesOwn) {
  Planners planners = trial_planners();
  for (const NamedPlanner& planner : planners.all()) EXPECT_EQ(planners.find(planner.name)->name, planner.name);
  EXPECT_EQ(
      planners.names(),
      "surface, attention, standard, sphere, random, random-contours, occlusion-aware, unobserved-voxel, "
      "rear-side-voxel, rear-side-entropy, proximity-count, average-entropy, area-factor, surface-edge, projection, "
      "oracle, oracle-2");
  EXPECT_NE(planners.find("saliency").error().message.find("surface, attention, standard"), std::string::npos);
  NamedPlanner own = attention_planner();
  own.name = "mine";
  own.min_gain = 7.0;
  planners.add(own);
  EXPECT_EQ(planners.find("mine")->min_gain, 7.0);
  own.min_gain = 8.0;
  planners.add(own);
  EXPECT_EQ(planners.find("mine")->min_gain, 8.0);
  EXPECT_EQ(planners.all().size(), 18U);
}

TEST(FlyingCamera, KeepsClearOfFixtures) {
  const RayScene rays = RayScene::build(random_clutter(5, 4)).value();
  const auto robot = flying_camera(rays);
  ASSERT_TRUE(robot);
  FreeRobot camera = *robot;
  const auto reaches = [&camera](const Eigen::Vector3d& p) {
    return camera.move_to(look_at(p, Eigen::Vector3d{0.0, 0.0, 0.1}))->has_value();
  };
  EXPECT_TRUE(reaches({0.5, 0.5, 0.5}));
  EXPECT_TRUE(reaches({-2.85, 0.0, 0.5}));   // 15 cm before the wall
  EXPECT_FALSE(reaches({-2.95, 0.0, 0.5}));  // 5 cm before it
  EXPECT_FALSE(reaches({-3.05, 0.0, 0.5}));  // in it
  EXPECT_FALSE(reaches({0.0, 0.0, -0.80}));  // in the floor
  EXPECT_TRUE(reaches({0.0, 0.0, 0.01}));    // on the table, which is no fixture
}

}  // namespace
}  // namespace saccade
