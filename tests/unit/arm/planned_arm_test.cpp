// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/planned_arm.hpp"

#include <gtest/gtest.h>

#include "saccade/arm/internal/executed_path.hpp"
#include "saccade/arm/internal/swept_cells.hpp"
#include "saccade/arm/motion_planner.hpp"
#include "support/test_arms.hpp"

namespace saccade {
namespace {

/// The Comau's kinematics with a slim body on its hand, in the middle of an unknown workspace.
class SimulatedArm : public ::testing::Test {
 protected:
  static ArmModel arm() {
    ArmDescription description = test::describe("slim", test::comau_rows());
    for (std::size_t i = 2; i < description.links.size(); ++i) {
      CollisionBody body;
      body.name = description.links[i].name;
      body.shape = SphereBody{0.05};
      description.links[i].bodies.push_back(body);
    }
    return ArmModel::create(std::move(description)).value();
  }
  static TsdfConfig map_config() {
    TsdfConfig config;
    config.voxel_size_m = 0.01;
    config.workspace = Box{{-1.2, -1.2, 0.0}, {1.2, 1.2, 1.6}};
    return config;
  }
  static PlannedArm robot(const PlannedArmConfig& config = {}) {
    return PlannedArm::create(arm(), map_config(), config).value();
  }
  /// Poses that the arm can take, apart from each other.
  static std::vector<Pose> poses(std::size_t count) {
    std::mt19937_64 random{4};
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < count; ++i) {
      Configuration q = test::random_configuration(arm(), random);
      poses.push_back(camera_pose(arm(), 0.3 * q));
    }
    return poses;
  }
};

TEST_F(SimulatedArm, StandsWhereItIsToldTo) {
  EXPECT_EQ(robot().configuration(), arm().middle());
  PlannedArmConfig config;
  config.start = 0.1 * Configuration::Ones(6);
  EXPECT_EQ(robot(config).configuration(), config.start);
  config.start = 0.1 * Configuration::Ones(5);
  EXPECT_EQ(PlannedArm::create(arm(), map_config(), config).error().code, Errc::invalid_argument);
  config.start = 100.0 * Configuration::Ones(6);
  EXPECT_EQ(PlannedArm::create(arm(), map_config(), config).error().code, Errc::invalid_argument);
  config.start.reset();
  config.first_poses = poses(1);
  const PlannedArm at_pose = robot(config);
  EXPECT_LT(test::miss(at_pose.T_world_camera(), config.first_poses[0]), 1e-6);
  PlannedArm placed = robot();
  EXPECT_TRUE(placed.place(0.2 * Configuration::Ones(6)).ok());
  EXPECT_EQ(placed.configuration(), Configuration{0.2 * Configuration::Ones(6)});
  EXPECT_FALSE(placed.place(0.2 * Configuration::Ones(7)).ok());
}

TEST_F(SimulatedArm, AStartThatTouchesAFixtureIsAnError) {
  PlannedArmConfig config;
  const Eigen::Vector3d hand = camera_pose(arm(), arm().middle()).translation();
  config.obstacles.fixtures = {Box{hand - Eigen::Vector3d::Constant(0.1), hand + Eigen::Vector3d::Constant(0.1)}};
  const auto made = PlannedArm::create(arm(), map_config(), config);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("touches an obstacle"), std::string::npos) << made.error().message;
}

TEST_F(SimulatedArm, WhatTheScanSweepsIsEnoughToGoThroughItAndNoMore) {
  PlannedArm moving = robot();
  TsdfMap map = TsdfMap::create(map_config()).value();
  const std::vector<Pose> scan = poses(4);
  // In a map that knows nothing, the arm cannot stir.
  ASSERT_EQ(moving.plan(scan)->refusal, Refusal::goal_in_collision);
  const std::vector<Box> swept = moving.swept_volume(scan).value();
  ASSERT_FALSE(swept.empty());
  double volume_m3 = 0.0;
  for (const Box& box : swept) {
    ASSERT_TRUE(map.free(box).ok());
    volume_m3 += (box.max - box.min).prod();
  }
  EXPECT_LT(volume_m3, 0.3 * (map_config().workspace->max - map_config().workspace->min).prod());
  ASSERT_TRUE(moving.follow(map.content(), Executor{}).ok());
  std::size_t reached = 0;
  for (const Pose& pose : scan) {
    const auto at = moving.move_to(pose);
    ASSERT_TRUE(at) << at.error().message;
    if (!*at) continue;
    ++reached;
    EXPECT_LT(test::miss(**at, pose), 1e-6);
    EXPECT_LT(test::miss(moving.T_world_camera(), pose), 1e-6);
  }
  EXPECT_EQ(reached, scan.size());
  EXPECT_GT(moving.motions().back().duration_s(), 0.5);
  // Nothing is swept twice.
  EXPECT_TRUE(moving.swept_volume({}).value().empty());
}

TEST_F(SimulatedArm, SweptCellsAreThoseThatTheArmTouches) {
  const ArmCollision collision = ArmCollision::create(arm()).value();
  const TsdfMap unseen = TsdfMap::create(map_config()).value();
  const ObstacleMap obstacles = ObstacleMap::create(unseen.content(), {}, Executor{}).value();
  std::mt19937_64 random{9};
  for (int i = 0; i < 5; ++i) {
    const Configuration q = test::random_configuration(arm(), random);
    SweptCells cells{collision, obstacles};
    cells.add(q);
    TsdfMap map = TsdfMap::create(map_config()).value();
    for (const Box& box : cells.boxes()) ASSERT_TRUE(map.free(box).ok());
    const ObstacleMap left = ObstacleMap::create(map.content(), {}, Executor{}).value();
    const auto contact = collision.contact(q, left);
    EXPECT_FALSE(contact && !contact->other_link);
    // No cell is far from the arm: the balls of its hand and links reach 5 cm, and a cell's diagonal is 7 cm.
    const ArmPoses at = forward_kinematics(arm(), q);
    for (const Box& box : cells.boxes()) {
      double nearest_m = 10.0;
      for (std::size_t link = 2; link <= 6; ++link) {
        nearest_m = std::min(nearest_m, (at.T_world_link[link].translation() - 0.5 * (box.min + box.max)).norm());
      }
      EXPECT_LT(nearest_m, 0.05 + 0.005 + SweptCells::kMargin_m + 0.035);
    }
  }
}

TEST_F(SimulatedArm, MovesAlongItsPlanAndSaysHowLongThatTakes) {
  PlannedArmConfig config;
  config.obstacles.unknown_is_obstacle = false;
  PlannedArm moving = robot(config);
  const std::vector<Pose> goals = poses(3);
  const PlannedMotion planned = moving.plan(goals).value();
  ASSERT_TRUE(planned.motion);
  EXPECT_EQ(moving.configuration(), arm().middle());  // nothing has moved
  std::vector<MotionSample> samples;
  const auto arrival = moving.execute(*planned.motion, [&](const MotionSample& sample) {
    samples.push_back(sample);
    return Advance::go_on;
  });
  ASSERT_TRUE(arrival && *arrival);
  EXPECT_EQ((*arrival)->motion_s, planned.motion->trajectory.duration_s());
  EXPECT_LT(test::miss((*arrival)->T_world_camera, goals[planned.motion->goal]), 1e-6);
  ASSERT_GE(samples.size(), 3U);
  EXPECT_LT(test::miss(samples.front().T_world_camera, camera_pose(arm(), arm().middle())), 1e-9);
  EXPECT_LT(test::miss(samples.back().T_world_camera, (*arrival)->T_world_camera), 1e-9);
  for (std::size_t i = 1; i < samples.size(); ++i) EXPECT_LE(samples[i].t_s - samples[i - 1].t_s, 0.02 + 1e-12);
  // Among several goals it takes the one reached soonest.
  PlannedArm again = robot(config);
  for (const Pose& goal : goals) {
    EXPECT_LE(planned.motion->trajectory.duration_s(),
              again.plan(std::span{&goal, 1})->motion->trajectory.duration_s() + 1e-9);
  }
  // A motion is made once, from where it begins.
  EXPECT_EQ(moving.execute(*planned.motion).error().code, Errc::invalid_argument);
}

/// Joints that stand short of where they were sent, or do not answer.
class LazyJoints final : public JointController {
 public:
  [[nodiscard]] Result<Configuration> position() override { return q; }
  [[nodiscard]] Result<JointArrival> execute(const Trajectory& trajectory, const JointObserver& observer) override {
    if (broken) return Error{Errc::unavailable, "the bus is silent", "joints"};
    EXPECT_EQ(observer({0.0, q, std::nullopt}), Advance::go_on);
    q = trajectory.at(0.5 * trajectory.duration_s()).q;
    return JointArrival{q};
  }
  Configuration q{0.1 * Configuration::Ones(6)};
  bool broken{false};
};

TEST_F(SimulatedArm, StandsWhereItsJointsSay) {
  PlannedArmConfig config;
  config.obstacles.unknown_is_obstacle = false;
  const auto joints = std::make_shared<LazyJoints>();
  PlannedArm moving = PlannedArm::create(arm(), map_config(), config, joints).value();
  EXPECT_EQ(moving.configuration(), joints->q);
  const PlannedMotion planned = moving.plan(poses(3)).value();
  ASSERT_TRUE(planned.motion);
  const auto arrival = moving.execute(*planned.motion, [](const MotionSample&) { return Advance::go_on; });
  ASSERT_TRUE(arrival && *arrival);
  EXPECT_EQ(moving.configuration(), joints->q);
  EXPECT_EQ((*arrival)->T_world_camera.matrix(), camera_pose(arm(), joints->q).matrix());
  joints->broken = true;
  const PlannedMotion next = moving.plan(poses(1)).value();
  ASSERT_TRUE(next.motion);
  EXPECT_EQ(moving.execute(*next.motion).error().message, "the bus is silent");
}

/// Returns an obstacle seen beside the hand of an arm that has come to the second of two poses: `ahead_m` on from where
/// it came.
class BackingOut : public SimulatedArm {
 protected:
  PlannedArm at_second(double ahead_m, double radius_m) {
    PlannedArm moving = robot();
    EXPECT_TRUE(map_.free(*map_config().workspace).ok());
    EXPECT_TRUE(moving.follow(map_.content(), Executor{}).ok());
    EXPECT_TRUE(*moving.move_to(poses(3)[0]));
    const Configuration first = *moving.configuration();
    EXPECT_TRUE(*moving.move_to(poses(3)[1]));
    const Configuration second = *moving.configuration();
    const auto hand = [](const Configuration& q) -> Eigen::Vector3d {
      return forward_kinematics(arm(), q).T_world_link[6].translation();
    };
    const Eigen::Vector3d on = hand(second) - hand(second + 0.05 * (first - second));
    EXPECT_TRUE(map_.forget(Sphere{hand(second) + ahead_m * on.normalized(), radius_m}).ok());
    EXPECT_TRUE(moving.follow(map_.content(), Executor{}).ok());
    EXPECT_TRUE(moving.reachability().collision().contact(second, moving.obstacles()));
    return moving;
  }
  TsdfMap map_{TsdfMap::create(map_config()).value()};
  std::vector<Pose> third_{poses(3)[2]};
};

TEST_F(BackingOut, AnArmLeavesTheWayItCameAndGoesOn) {
  PlannedArm moving = at_second(0.07, 0.02);
  const ArmCollision& collision = moving.reachability().collision();
  const Configuration stood = *moving.configuration();
  EXPECT_EQ(moving.plan(third_, MotionKind::direct)->refusal, Refusal::start_in_collision) << "no detour was wanted";
  const PlannedMotion planned = moving.plan(third_).value();
  ASSERT_TRUE(planned.motion);
  const Motion& motion = *planned.motion;
  ASSERT_GT(motion.retreat_s, 0.0);
  ASSERT_GT(motion.trajectory.duration_s(), motion.retreat_s);
  EXPECT_LT(test::distance(motion.trajectory.at(0.0).q, stood), 1e-9);
  EXPECT_LT(motion.trajectory.at(motion.retreat_s).speed.norm(), 1e-6) << "it stops before it goes on";
  EXPECT_FALSE(collision.contact(motion.trajectory.at(motion.retreat_s).q, moving.obstacles()));
  const std::vector<double> at_first_m = obstacle_depths_m(stood, collision, moving.obstacles());
  for (double t_s = 0.0; t_s <= motion.trajectory.duration_s(); t_s += 0.01) {
    const std::vector<double> depths_m = obstacle_depths_m(motion.trajectory.at(t_s).q, collision, moving.obstacles());
    for (std::size_t link = 0; link < depths_m.size(); ++link) EXPECT_LE(depths_m[link], at_first_m[link] + 1e-3);
  }
  ASSERT_TRUE(moving.execute(motion).value());
  EXPECT_LT(test::miss(moving.T_world_camera(), third_[0]), 1e-6);
  const PlannedMotion next = moving.plan(std::vector{poses(3)[0]}).value();
  ASSERT_TRUE(next.motion);
  EXPECT_EQ(next.motion->retreat_s, 0.0);
}

TEST_F(BackingOut, NeverDeeper) {
  PlannedArm moving = at_second(-0.05, 0.08);  // across the way back
  const PlannedMotion planned = moving.plan(third_).value();
  EXPECT_FALSE(planned.motion);
  EXPECT_EQ(planned.refusal, Refusal::start_in_collision);
}

TEST_F(BackingOut, AnArmThatWasPutThereKnowsNoWayBack) {
  PlannedArm moving = at_second(0.07, 0.02);
  ASSERT_TRUE(moving.place(*moving.configuration()).ok());
  ASSERT_TRUE(moving.follow(map_.content(), Executor{}).ok());
  EXPECT_EQ(moving.plan(third_)->refusal, Refusal::start_in_collision);
}

TEST_F(SimulatedArm, AWayBackBeginsWhereTheArmStands) {
  const ArmCollision collision = ArmCollision::create(arm()).value();
  const ObstacleMap unseen =
      ObstacleMap::create(TsdfMap::create(map_config()).value().content(), {}, Executor{}).value();
  const Configuration from = Configuration::Zero(6);
  const Configuration to = 0.2 * Configuration::Ones(6);
  ExecutedPath way;
  EXPECT_FALSE(way.retreat_from(to, collision, unseen)) << "nothing was driven";
  way.add(parametrise(arm(), {from, to}));
  EXPECT_FALSE(way.retreat_from(to, collision, unseen)) << "all is unknown";
  TsdfMap map = TsdfMap::create(map_config()).value();
  ASSERT_TRUE(map.free(*map_config().workspace).ok());
  const ObstacleMap free = ObstacleMap::create(map.content(), {}, Executor{}).value();
  const Configuration nearly = to + 0.005 * Configuration::Ones(6);
  const auto back = way.retreat_from(nearly, collision, free);
  ASSERT_TRUE(back);
  EXPECT_LT(test::distance(back->at(0.0).q, nearly), 1e-12);
  EXPECT_LT(test::distance(back->end(), from), 1e-9);
  EXPECT_FALSE(way.retreat_from(to + 0.02 * Configuration::Ones(6), collision, free));
  EXPECT_FALSE(way.retreat_from(Configuration::Zero(5), collision, free));
  for (std::size_t i = 0; i < ExecutedPath::kMostPieces; ++i) way.add(parametrise(arm(), {to, to}));
  const auto forgotten = way.retreat_from(to, collision, free);
  ASSERT_TRUE(forgotten);
  EXPECT_LT(test::distance(forgotten->end(), to), 1e-9);
}

TEST_F(SimulatedArm, RefusalsHaveReasons) {
  PlannedArmConfig config;
  config.obstacles.unknown_is_obstacle = false;
  PlannedArm moving = robot(config);
  const Pose far{Eigen::Translation3d{9.0, 0.0, 0.0}};
  EXPECT_EQ(moving.plan(std::span{&far, 1})->refusal, Refusal::no_ik);
  EXPECT_EQ(moving.move_to(far).value(), std::nullopt);
  const std::vector<std::optional<Refusal>> tested = moving.test(std::vector{far, poses(1)[0]}, Executor{});
  EXPECT_EQ(tested[0], Refusal::no_ik);
  EXPECT_EQ(tested[1], std::nullopt);
  const std::vector<Pose> mixed{far, poses(1)[0]};
  EXPECT_EQ(moving.plan(mixed)->motion->goal, 1U);
}

}  // namespace
}  // namespace saccade
