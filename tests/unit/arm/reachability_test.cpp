// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/reachability.hpp"

#include <gtest/gtest.h>

#include "support/effort.hpp"
#include "support/sliding_arms.hpp"

namespace saccade {
namespace {

/// The Comau with a ball around its hand, and limits that matter.
ArmModel armed() {
  ArmDescription description = test::describe("comau", test::comau_rows());
  description.links.back().bodies.push_back({"hand", Pose::Identity(), SphereBody{0.08}});
  for (const std::size_t i : {0U, 1U, 2U}) {
    description.joints[i].limits.lower = -1.4;
    description.joints[i].limits.upper = 1.4;
  }
  return test::with_camera(description);
}

Pose moved(Pose pose, const Eigen::Vector3d& by_m) {
  pose.pretranslate(by_m);
  return pose;
}

TEST(Reachability, GivesEveryFreeConfiguration) {
  const ArmModel model = armed();
  const Reachability reachability = Reachability::create(ArmCollision::create(model).value()).value();
  const ObstacleMap nothing = test::only({});
  std::mt19937_64 random{5};
  for (int i = 0; i < test::scaled_cases(200); ++i) {
    const Configuration q = test::random_configuration(model, random);
    const Pose T_world_camera = camera_pose(model, q);
    const PoseGoals goals = reachability.goals(T_world_camera, model.middle(), nothing);
    ASSERT_FALSE(goals.refusal);
    EXPECT_LT(test::nearest(goals.free, q), 1e-6);
    for (const Configuration& goal : goals.free) {
      EXPECT_LT(test::miss(camera_pose(model, goal), T_world_camera), 1e-6);
      EXPECT_TRUE(model.within_limits(goal));
    }
  }
}

/// Whole turns of a joint change no collision, so that wide limits give no other answers, and not 2^6 times the work.
TEST(Reachability, WholeTurnsChangeNothing) {
  ArmDescription wide = armed().description();
  for (ArmJoint& joint : wide.joints) {
    joint.limits.lower = -6.28;
    joint.limits.upper = 6.28;
  }
  ArmDescription once = wide;
  for (ArmJoint& joint : once.joints) {
    joint.limits.lower = -3.15;
    joint.limits.upper = 3.15;
  }
  const ArmModel model = ArmModel::create(wide).value();
  const Reachability turning = Reachability::create(ArmCollision::create(model).value()).value();
  const Reachability plain = Reachability::create(ArmCollision::create(ArmModel::create(once).value()).value()).value();
  const ObstacleMap wall = test::only({Box{{0.5, -2.0, -2.0}, {0.6, 2.0, 2.0}}});
  std::mt19937_64 random{15};
  std::vector<Pose> poses;
  for (int i = 0; i < 60; ++i) poses.push_back(camera_pose(model, test::random_configuration(model, random)));
  const auto refusals = turning.test(poses, model.middle(), wall, Executor{});
  EXPECT_EQ(refusals, plain.test(poses, model.middle(), wall, Executor{}));
  EXPECT_GT(std::count(refusals.begin(), refusals.end(), Refusal::goal_in_collision), 5);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const PoseGoals goals = turning.goals(poses[i], model.middle(), wall);
    EXPECT_EQ(goals.free.empty(), refusals[i].has_value()) << i;
    for (const Configuration& q : goals.free) EXPECT_LT(test::miss(camera_pose(model, q), poses[i]), 1e-6);
  }
}

TEST(Reachability, SaysWhyThereIsNone) {
  const ArmModel model = armed();
  const Reachability reachability = Reachability::create(ArmCollision::create(model).value()).value();
  const ObstacleMap nothing = test::only({});
  Configuration q = model.middle();
  q[2] += 0.4;
  q[4] += 0.5;
  const Pose T_world_camera = camera_pose(model, q);
  const auto refusal = [&](const Pose& pose, const ObstacleMap& obstacles) {
    const PoseGoals goals = reachability.goals(pose, model.middle(), obstacles);
    EXPECT_EQ(goals.free.empty(), goals.refusal.has_value());
    return goals.refusal;
  };
  EXPECT_EQ(refusal(T_world_camera, nothing), std::nullopt);
  EXPECT_EQ(refusal(moved(T_world_camera, {10.0, 0.0, 0.0}), nothing), Refusal::no_ik);
  // Everywhere is an obstacle.
  EXPECT_EQ(refusal(T_world_camera, test::only({Box{{-9.0, -9.0, -9.0}, {9.0, 9.0, 9.0}}})),
            Refusal::goal_in_collision);
  // A pose behind the arm, which only a first joint turned farther would reach; the arm can look over its shoulder
  // otherwise, so some of these are within limits and some are not.
  int outside = 0;
  for (double angle_rad = 1.6; angle_rad < 3.0; angle_rad += 0.02) {
    Configuration turned = q;
    turned[0] = angle_rad;
    const auto one = refusal(camera_pose(model, turned), nothing);
    outside += one == Refusal::outside_limits ? 1 : 0;
    EXPECT_NE(one, Refusal::no_ik) << angle_rad;
  }
  EXPECT_GT(outside, 3);
}

/// An arm with seven joints that has a ball around its hand and one around its elbow.
ArmModel armed_with_seven(const std::vector<test::DhRow>& rows) {
  ArmDescription description = test::describe("seven", rows);
  description.links.back().bodies.push_back({"hand", Pose::Identity(), SphereBody{0.08}});
  description.links[4].bodies.push_back({"elbow", Pose::Identity(), SphereBody{0.1}});
  description.joints[0].limits.lower = -1.0;
  description.joints[0].limits.upper = 1.0;
  description.joints[2].limits = description.joints[0].limits;
  return test::with_camera(description);
}

class ManyPoses : public testing::TestWithParam<ArmModel> {};

TEST_P(ManyPoses, AreAnsweredAsOneByOne) {
  const ArmModel model = GetParam();
  const Reachability reachability = Reachability::create(ArmCollision::create(model).value()).value();
  const Eigen::Vector3d hand = camera_pose(model, model.middle()).translation();
  const ObstacleMap obstacles = test::only({Box{hand - Eigen::Vector3d{0.6, 0.6, 0.2}, hand}});
  std::mt19937_64 random{6};
  std::uniform_real_distribution<double> shift{-1.5, 1.5};
  std::vector<Pose> poses;
  for (int i = 0; i < 1000; ++i) {
    const Pose T_world_camera = camera_pose(model, test::random_configuration(model, random));
    poses.push_back(i % 2 == 0 ? T_world_camera : moved(T_world_camera, {shift(random), shift(random), shift(random)}));
  }
  const auto refusals = reachability.test(poses, model.middle(), obstacles, Executor{});
  ASSERT_EQ(refusals.size(), poses.size());
  std::array<int, kRefusalNames.values.size()> counted{};
  int free = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(refusals[i], reachability.goals(poses[i], model.middle(), obstacles).refusal) << i;
    refusals[i] ? ++counted[static_cast<std::size_t>(*refusals[i])] : ++free;
  }
  EXPECT_GT(free, 50);
  for (const Refusal refusal : {Refusal::no_ik, Refusal::outside_limits, Refusal::goal_in_collision}) {
    EXPECT_GT(counted[static_cast<std::size_t>(refusal)], 10) << to_string(refusal);
  }
  EXPECT_EQ(reachability.test(poses, model.middle(), obstacles, Executor::with_threads(3)), refusals);
  EXPECT_TRUE(reachability.test({}, model.middle(), obstacles, Executor{}).empty());
}

INSTANTIATE_TEST_SUITE_P(Reachability, ManyPoses,
                         testing::Values(armed(), armed_with_seven(test::panda_rows()),
                                         armed_with_seven(test::iiwa_rows())));

TEST(Reachability, ArmsWithOtherJointsAreSolvedNumerically) {
  const ArmModel rail = test::with_camera(test::plane_arm({JointKind::prismatic, JointKind::revolute}).description());
  const auto reachability = Reachability::create(ArmCollision::create(rail).value());
  ASSERT_TRUE(reachability.ok()) << reachability.error().to_string();
  EXPECT_EQ(reachability->ik().method(), IkMethod::numeric);
  const Configuration q = test::joints({0.2, 0.7});
  const PoseGoals goals = reachability->goals(camera_pose(rail, q), rail.middle(), test::only({}));
  ASSERT_FALSE(goals.refusal);
  EXPECT_LT(test::nearest(goals.free, q), 1e-3);
  // The rail is not long enough; a joint that slides keeps its limits, so this is out of reach.
  const Pose far = camera_pose(rail, test::joints({0.9, 0.7}));
  EXPECT_EQ(reachability->goals(far, rail.middle(), test::only({})).refusal, Refusal::no_ik);
  // The arm that turns would reach, but for its limit.
  const Pose turned = camera_pose(rail, test::joints({0.2, 3.1}));
  EXPECT_EQ(reachability->goals(turned, rail.middle(), test::only({})).refusal, Refusal::outside_limits);
}

TEST(Reachability, RefusesWhatInverseKinematicsRefuses) {
  IkConfig config;
  config.method = IkMethod::closed_form;
  const auto refused = Reachability::create(ArmCollision::create(test::three_bars()).value(), config);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, Errc::unsupported);
}

}  // namespace
}  // namespace saccade
