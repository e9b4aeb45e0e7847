// SPDX-License-Identifier: Apache-2.0
// Kinematics of the recorded arms against Orocos KDL, and inverse kinematics against the way back.
#include <gtest/gtest.h>

#include <filesystem>

#include "saccade/arm/inverse_kinematics.hpp"
#include "saccade/arm/kinematics.hpp"
#include "support/effort.hpp"
#include "support/kdl_arm.hpp"
#include "support/shared_arms.hpp"
#include "support/test_arms.hpp"

namespace saccade {
namespace {

constexpr std::uint64_t kArmSeed{20};

class RecordedArms : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(test::shared_robots())) GTEST_SKIP() << "no robots among the recorded data";
    RecordProperty("seed", static_cast<int>(kArmSeed));
  }
};

TEST_F(RecordedArms, PosesAndJacobiansAreThoseOfKdl) {
  std::mt19937_64 random{kArmSeed};
  int cases = 0;
  for (const auto& read : {test::shared_comau(false), test::shared_panda(), test::shared_iiwa()}) {
    ASSERT_TRUE(read) << read.error().to_string();
    test::KdlArm kdl{read->arm};
    for (int i = 0; i < test::scaled_cases(5000); ++i, ++cases) {
      const Configuration q = test::random_configuration(read->arm, random);
      ASSERT_LT(test::miss(camera_pose(read->arm, q), kdl.camera_pose(q)), 1e-13);
      ASSERT_LT((camera_jacobian(read->arm, q) - kdl.camera_jacobian(q)).norm(), 1e-12);
    }
  }
  EXPECT_EQ(cases, 3 * test::scaled_cases(5000));
}

TEST_F(RecordedArms, TheComausConfigurationsAreFoundAgain) {
  for (const bool exact : {true, false}) {
    const auto read = test::shared_comau(exact);
    ASSERT_TRUE(read) << read.error().to_string();
    const InverseKinematics ik = InverseKinematics::create(read->arm).value();
    ASSERT_EQ(ik.method(), IkMethod::closed_form) << ik.why_numeric();
    std::mt19937_64 random{kArmSeed};
    const int cases = test::scaled_cases(20000);
    int again = 0;
    for (int i = 0; i < cases; ++i) {
      const Configuration q = test::random_configuration(ik.arm(), random);
      const Pose T = camera_pose(ik.arm(), q);
      const std::vector<Configuration> solutions = ik.solve(T);
      for (const Configuration& solution : solutions) {
        ASSERT_TRUE(ik.arm().within_limits(solution));
        ASSERT_LT(test::miss(camera_pose(ik.arm(), solution), T), kIkTolerance);
      }
      again += test::nearest(solutions, q) < 1e-5 ? 1 : 0;
    }
    // Its rounded angles move the wrist's centre by 0.6 µm: next to straight wrists a solution may get lost.
    EXPECT_GE(again, exact ? cases : cases - cases / 500) << "seed " << kArmSeed;
  }
}

TEST_F(RecordedArms, SevenJointsAreFoundAgainInClosedForm) {
  for (const auto& read : {test::shared_panda(), test::shared_panda_hand(), test::shared_iiwa()}) {
    ASSERT_TRUE(read) << read.error().to_string();
    const InverseKinematics ik = InverseKinematics::create(read->arm).value();
    ASSERT_EQ(ik.method(), IkMethod::closed_form) << ik.why_numeric();
    std::mt19937_64 random{kArmSeed};
    const int cases = test::scaled_cases(5000);
    int from_middle = 0;
    double worst = 0.0;
    for (int i = 0; i < cases; ++i) {
      const Configuration q = test::random_configuration(ik.arm(), random);
      const Pose T = camera_pose(ik.arm(), q);
      const std::vector<Configuration> solutions = ik.solve(T, q);
      for (const Configuration& solution : solutions) {
        ASSERT_TRUE(ik.arm().within_limits(solution));
        ASSERT_LT(test::miss(camera_pose(ik.arm(), solution), T), kIkTolerance);
      }
      worst = std::max(worst, test::nearest(solutions, q));
      from_middle += ik.any_of(T, ik.arm().middle(), [](const Configuration&) { return true; }) ? 1 : 0;
    }
    EXPECT_LT(worst, 1e-5) << ik.arm().name() << ", seed " << kArmSeed;
    // The values that are tried may all lie outside what a pose leaves to the last joint.
    EXPECT_GE(from_middle, cases - cases / 50) << ik.arm().name() << ", seed " << kArmSeed;
  }
}

TEST_F(RecordedArms, SevenJointsAreSolvedByIterationWhereAsked) {
  std::mt19937_64 random{kArmSeed};
  IkConfig config;
  config.method = IkMethod::numeric;
  for (const auto& read : {test::shared_panda(), test::shared_iiwa()}) {
    ASSERT_TRUE(read) << read.error().to_string();
    const InverseKinematics ik = InverseKinematics::create(read->arm, config).value();
    EXPECT_EQ(ik.method(), IkMethod::numeric);
    EXPECT_EQ(ik.why_numeric(), "");
    const int cases = test::scaled_cases(200);
    int found = 0;
    for (int i = 0; i < cases; ++i) {
      const Pose T = camera_pose(ik.arm(), test::random_configuration(ik.arm(), random));
      const std::vector<Configuration> solutions = ik.solve(T);
      for (const Configuration& q : solutions) {
        ASSERT_TRUE(ik.arm().within_limits(q));
        ASSERT_LT(test::miss(camera_pose(ik.arm(), q), T), kIkTolerance);
      }
      found += solutions.empty() ? 0 : 1;
    }
    EXPECT_GE(found, cases - cases / 50) << ik.arm().name() << ", seed " << kArmSeed;
  }
}

}  // namespace
}  // namespace saccade
