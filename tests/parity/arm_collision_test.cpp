// SPDX-License-Identifier: Apache-2.0
// Arms against obstacles and themselves, beside FCL with a box per obstacle cell and the bodies as they are described.
// SACCADE_COLLISION_CASES: configurations per arm (3000).
#include "saccade/robot/arm_collision.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "support/effort.hpp"
#include "support/fcl_arm.hpp"
#include "support/shared_arms.hpp"
#include "support/test_arms.hpp"

namespace saccade {
namespace {

constexpr double kNear_m{0.05};   ///< of contact
constexpr int kDistanceEvery{8};  ///< distances to meshes take FCL long

int cases() {
  const char* wanted = std::getenv("SACCADE_COLLISION_CASES");
  return wanted != nullptr ? std::atoi(wanted) : test::scaled_cases(3000);
}

struct Tally {
  int free{0};        ///< by FCL
  int called{0};      ///< of these, contacts by ours
  int collisions{0};  ///< by FCL
};

void compare(const ArmModel& model) {
  ArmCollisionConfig config;
  if (test::kSanitized) config.max_excess_m = 0.01;  // fewer balls
  const auto arm = ArmCollision::create(model, config);
  ASSERT_TRUE(arm.ok()) << arm.error().to_string();
  std::mt19937_64 random{11};
  const ObstacleMap obstacles =
      test::clutter_around(forward_kinematics(model, model.middle()).T_world_link[1].translation(), random);
  test::FclArm fcl{*arm, obstacles};
  Tally all;
  Tally near;
  for (int i = 0; i < cases(); ++i) {
    const Configuration q = test::random_configuration(model, random);
    const ArmPoses poses = forward_kinematics(model, q);
    const bool ours = arm->contact(poses, obstacles).has_value();
    if (fcl.collides(poses)) {
      ++all.collisions;
      EXPECT_TRUE(ours) << model.name() << " at " << q.transpose();
      continue;
    }
    ++all.free;
    all.called += ours ? 1 : 0;
    if (i % kDistanceEvery != 0 || fcl.distance_m(poses) > kNear_m) continue;
    ++near.free;
    near.called += ours ? 1 : 0;
  }
  const double share = static_cast<double>(all.collisions) / cases();
  std::cout << model.name() << ": " << cases() << " configurations, " << 100.0 * share << " % collide; of " << all.free
            << " free ones " << all.called << " are called contacts; within " << 100.0 * kNear_m << " cm "
            << near.called << " of " << near.free << '\n';
  EXPECT_GT(all.collisions, 0);
  if (test::kSanitized) return;  // too few for shares, and covered by coarser balls
  EXPECT_GT(share, 0.3);
  EXPECT_LT(share, 0.7);
  EXPECT_LE(all.called, 0.05 * all.free);
}

TEST(ArmCollisionParity, BuiltInComauIsNeverFreeWhereFclCollides) { compare(find_robot("comau_smart_six")->arm); }

TEST(ArmCollisionParity, RecordedHullsAreNeverFreeWhereFclCollides) {
  if (!std::filesystem::exists(test::shared_robots())) GTEST_SKIP() << "no " << test::shared_robots();
  compare(test::shared_comau(true)->arm);
}

}  // namespace
}  // namespace saccade
