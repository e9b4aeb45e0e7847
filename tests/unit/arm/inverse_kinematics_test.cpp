// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/inverse_kinematics.hpp"

#include <gtest/gtest.h>

#include "saccade/arm/internal/joint_turns.hpp"
#include "saccade/arm/internal/numeric_ik.hpp"
#include "saccade/arm/kinematics.hpp"
#include "support/effort.hpp"
#include "support/test_arms.hpp"

namespace saccade {
namespace {

using std::numbers::pi;
using test::describe;
using test::random_configuration;

InverseKinematics ik_of(ArmModel arm, const IkConfig& config = {}) {
  return InverseKinematics::create(std::move(arm), config).value();
}

IkConfig every_turn() {
  IkConfig config;
  config.max_turns = 16;
  return config;
}

void expect_all_meet(const InverseKinematics& ik, const std::vector<Configuration>& solutions, const Pose& T) {
  for (const Configuration& q : solutions) {
    ASSERT_TRUE(ik.arm().within_limits(q)) << q.transpose();
    ASSERT_LT(test::miss(camera_pose(ik.arm(), q), T), kIkTolerance) << q.transpose();
  }
}

class ClosedForm : public testing::TestWithParam<std::vector<test::DhRow>> {};

TEST_P(ClosedForm, FindsEveryConfigurationAgain) {
  const InverseKinematics ik = ik_of(test::with_camera(describe("arm", GetParam())), every_turn());
  ASSERT_EQ(ik.method(), IkMethod::closed_form) << ik.why_numeric();
  EXPECT_FALSE(ik.refines());
  std::mt19937_64 random{11};
  const int cases = test::scaled_cases(20000);
  std::size_t most = 0;
  double worst = 0.0;
  for (int i = 0; i < cases; ++i) {
    const Configuration q = random_configuration(ik.arm(), random);
    const Pose T = camera_pose(ik.arm(), q);
    const std::vector<Configuration> solutions = ik.solve(T);
    expect_all_meet(ik, solutions, T);
    worst = std::max(worst, test::nearest(solutions, q));
    most = std::max(most, solutions.size());
  }
  EXPECT_LT(worst, 1e-5);  // next to singular poses a joint moves far while the camera does not
  EXPECT_GE(most, 8U);
}

TEST_P(ClosedForm, FindsNothingTwice) {
  const InverseKinematics ik = ik_of(test::with_camera(describe("arm", GetParam())));
  std::mt19937_64 random{12};
  for (int i = 0; i < test::scaled_cases(2000); ++i) {
    const std::vector<Configuration> solutions =
        ik.solve(camera_pose(ik.arm(), random_configuration(ik.arm(), random)));
    for (std::size_t a = 0; a < solutions.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) ASSERT_GT(test::distance(solutions[a], solutions[b]), 1e-9);
    }
  }
}

TEST_P(ClosedForm, FindsNothingBeyondTheReach) {
  const InverseKinematics ik = ik_of(test::with_camera(describe("arm", GetParam())));
  std::mt19937_64 random{13};
  int reached = 0;
  for (int i = 0; i < test::scaled_cases(2000); ++i) {
    Pose T = camera_pose(ik.arm(), random_configuration(ik.arm(), random));
    const Eigen::Vector3d base = ik.arm().T_world_base().translation();
    T.translation() = base + 1.5 * (T.translation() - base);
    const std::vector<Configuration> solutions = ik.solve(T);
    expect_all_meet(ik, solutions, T);
    reached += solutions.empty() ? 0 : 1;
  }
  EXPECT_LT(reached, test::scaled_cases(2000));
  Pose far = Pose::Identity();
  far.translation().x() = 100.0;
  EXPECT_TRUE(ik.solve(far).empty());
  far.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(ik.solve(far).empty());
}

TEST_P(ClosedForm, HandlesStraightWristsAndStretchedArms) {
  const InverseKinematics ik = ik_of(test::with_camera(describe("arm", GetParam())), every_turn());
  std::mt19937_64 random{14};
  int cases = 0;
  for (int i = 0; i < test::scaled_cases(500); ++i) {
    Configuration q = random_configuration(ik.arm(), random);
    for (const double near : {0.0, 1e-12, 1e-9, 1e-7, 1e-4}) {
      for (const double angle : {0.0, 0.5 * pi, -0.5 * pi, pi}) {
        for (const int joint : {2, 4}) {
          Configuration singular = q;
          singular[joint] = std::clamp(angle + near, -pi, pi);
          const Pose T = camera_pose(ik.arm(), singular);
          const std::vector<Configuration> solutions = ik.solve(T, singular);
          ASSERT_FALSE(solutions.empty()) << singular.transpose();
          expect_all_meet(ik, solutions, T);
          ++cases;
        }
      }
    }
  }
  EXPECT_EQ(cases, 40 * test::scaled_cases(500));
}

INSTANTIATE_TEST_SUITE_P(Arms, ClosedForm,
                         testing::Values(test::comau_rows(), test::offset_rows(), test::oblique_rows(), test::ur_rows(),
                                         test::oblique_parallel_rows(), test::spherical_shoulder_rows()));

TEST(InverseKinematics, KeepsTheReferencesTurnWhereTheWristIsStraight) {
  const InverseKinematics ik = ik_of(test::with_camera(describe("comau", test::comau_rows())));
  Configuration q{6};
  q << 0.3, 0.2, -1.5, 0.7, 0.0, 0.4;
  const Pose T = camera_pose(ik.arm(), q);
  EXPECT_LT(test::nearest(ik.solve(T, q), q), 1e-9);
  Configuration reference = q;
  reference[3] = -0.5;
  const std::vector<Configuration> solutions = ik.solve(T, reference);
  ASSERT_FALSE(solutions.empty());
  for (const Configuration& solution : solutions) {
    if (std::fabs(solution[4]) > 1e-9 || std::fabs(solution[2] - q[2]) > 1e-9) continue;
    EXPECT_EQ(solution[3], -0.5);
  }
}

TEST(InverseKinematics, JointFourGivesWayToTheLimitsOfJointSix) {
  ArmDescription description = describe("comau", test::comau_rows());
  description.joints[5].limits.lower = -0.1;
  description.joints[5].limits.upper = 0.1;
  const InverseKinematics ik = ik_of(test::with_camera(std::move(description)));
  Configuration q{6};
  q << 0.3, 0.2, -1.5, 1.9, 0.0, 0.05;
  const Pose T = camera_pose(ik.arm(), q);
  const std::vector<Configuration> solutions = ik.solve(T, ik.arm().middle());
  ASSERT_FALSE(solutions.empty());
  expect_all_meet(ik, solutions, T);
}

TEST(InverseKinematics, ListsWholeTurnsNearestFirst) {
  ArmDescription description = describe("comau", test::comau_rows());
  description.joints[5].limits.lower = -47.1;
  description.joints[5].limits.upper = 47.1;
  description.joints[3].kind = JointKind::continuous;
  const ArmModel arm = ArmModel::create(std::move(description)).value();
  Configuration q = Configuration::Zero(6);
  q[5] = 1.0;
  q[3] = 0.5;
  Configuration reference = Configuration::Zero(6);
  reference[5] = 20.0;
  reference[3] = 100.0;
  std::vector<Configuration> solutions;
  append_turns(arm, q, reference, 3, solutions);
  ASSERT_EQ(solutions.size(), 3U);
  EXPECT_NEAR(solutions[0][5], 1.0 + 6.0 * pi, 1e-12);
  EXPECT_NEAR(solutions[1][5], 1.0 + 8.0 * pi, 1e-12);
  EXPECT_NEAR(solutions[2][5], 1.0 + 4.0 * pi, 1e-12);
  EXPECT_NEAR(solutions[0][3], 0.5 + 32.0 * pi, 1e-12);
  solutions.clear();
  append_turns(arm, q, reference, 50, solutions);
  EXPECT_EQ(solutions.size(), 15U);
  reference[5] = 1000.0;
  solutions.clear();
  append_turns(arm, q, reference, 1, solutions);
  ASSERT_EQ(solutions.size(), 1U);
  EXPECT_NEAR(solutions[0][5], 1.0 + 14.0 * pi, 1e-12);
  q[1] = 3.3;  // −2.98 is within ±π
  solutions.clear();
  append_turns(arm, q, reference, 1, solutions);
  ASSERT_EQ(solutions.size(), 1U);
  EXPECT_NEAR(solutions[0][1], 3.3 - 2.0 * pi, 1e-12);
}

TEST(InverseKinematics, SaysWhyThereIsNoClosedForm) {
  const auto why = [](const std::function<void(ArmDescription&)>& change) {
    ArmDescription description = describe("comau", test::comau_rows());
    change(description);
    const InverseKinematics ik = ik_of(ArmModel::create(std::move(description)).value());
    EXPECT_EQ(ik.method(), IkMethod::numeric);
    return ik.why_numeric();
  };
  EXPECT_EQ(why([](ArmDescription& d) { d.joints.pop_back(), d.links.pop_back(); }),
            "no closed form: it has 5 joints, not six");
  EXPECT_EQ(why([](ArmDescription& d) { d.joints[1].kind = JointKind::prismatic; }),
            "no closed form: joint joint_2 is prismatic");
  EXPECT_EQ(why([](ArmDescription& d) { d.joints[5].T_parent_joint.translation().x() += 0.01; }),
            "no closed form: the last three axes do not meet in a point");
  EXPECT_EQ(why([](ArmDescription& d) { d.joints[1].axis_joint.x() = 0.1; }),
            "no closed form: axes 2 and 3 are not parallel");
  ArmDescription bent = describe("comau", test::comau_rows());
  bent.joints[1].axis_joint.x() = 0.1;
  IkConfig closed;
  closed.method = IkMethod::closed_form;
  const auto refused = InverseKinematics::create(ArmModel::create(std::move(bent)).value(), closed);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::unsupported);
}

TEST(InverseKinematics, RefinesForAnArmThatWasRoundedOff) {
  ArmDescription description = describe("comau", test::comau_rows());
  description.joints[5].T_parent_joint.translation().x() += 1e-6;
  description.joints[2].axis_joint.x() += 1e-5;
  const InverseKinematics ik = ik_of(test::with_camera(std::move(description)));
  ASSERT_EQ(ik.method(), IkMethod::closed_form);
  EXPECT_TRUE(ik.refines());
  std::mt19937_64 random{15};
  int again = 0;
  for (int i = 0; i < test::scaled_cases(1000); ++i) {
    const Configuration q = random_configuration(ik.arm(), random);
    const Pose T = camera_pose(ik.arm(), q);
    const std::vector<Configuration> solutions = ik.solve(T);
    expect_all_meet(ik, solutions, T);
    again += test::nearest(solutions, q) < 1e-5 ? 1 : 0;
  }
  EXPECT_GE(again, test::scaled_cases(1000) * 99 / 100);
}

TEST(InverseKinematics, ABatchIsItsPosesOneByOneForAnyThreadCount) {
  const InverseKinematics ik = ik_of(test::with_camera(describe("comau", test::comau_rows())));
  std::mt19937_64 random{16};
  std::vector<Pose> poses;
  for (int i = 0; i < 1500; ++i) poses.push_back(camera_pose(ik.arm(), random_configuration(ik.arm(), random)));
  poses[3].translation().x() += 50.0;
  const IkTable one = ik.solve_all(poses, ik.arm().middle(), {});
  const IkTable many = ik.solve_all(poses, ik.arm().middle(), Executor::with_threads(3));
  EXPECT_EQ(one.first, many.first);
  EXPECT_EQ(one.values, many.values);
  ASSERT_EQ(one.poses(), poses.size());
  EXPECT_EQ(one.count(3), 0U);
  EXPECT_GT(one.solutions(), poses.size());
  for (std::size_t i = 0; i < poses.size(); i += 100) {
    const std::vector<Configuration> alone = ik.solve(poses[i]);
    ASSERT_EQ(alone.size(), one.count(i));
    for (std::size_t k = 0; k < alone.size(); ++k) EXPECT_EQ(alone[k], one.solution(i, k));
  }
  EXPECT_EQ(ik.solve_all({}, ik.arm().middle(), {}).poses(), 0U);
}

TEST(NumericIk, FindsPosesWithinTheLimits) {
  const auto arm = std::make_shared<const ArmModel>(test::with_camera(describe("comau", test::comau_rows())));
  const NumericIk ik = NumericIk::create(arm).value();
  std::mt19937_64 random{17};
  const int cases = test::scaled_cases(100);
  int found = 0;
  for (int i = 0; i < cases; ++i) {
    const Pose T = camera_pose(*arm, random_configuration(*arm, random));
    const std::vector<Configuration> solutions = ik.solve(T, arm->middle());
    EXPECT_EQ(solutions, ik.solve(T, arm->middle()));
    for (const Configuration& q : solutions) {
      EXPECT_TRUE(arm->within_limits(q));
      EXPECT_LT(test::miss(camera_pose(*arm, q), T), kIkTolerance);
    }
    found += solutions.empty() ? 0 : 1;
  }
  EXPECT_EQ(found, cases);
}

TEST(NumericIk, FindsSeveralSolutionsWhereAsked) {
  const auto arm = std::make_shared<const ArmModel>(test::with_camera(describe("comau", test::comau_rows())));
  NumericIkConfig several;
  several.max_solutions = 4;
  const NumericIk ik = NumericIk::create(arm, several).value();
  Configuration q{6};
  q << 0.3, 0.2, -1.5, 0.7, 0.6, 0.4;
  const std::vector<Configuration> solutions = ik.solve(camera_pose(*arm, q), q);
  ASSERT_EQ(solutions.size(), 4U);
  EXPECT_LT(test::distance(solutions[0], q), 1e-8);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_GT(test::distance(solutions[i], solutions[0]), 0.05);
  several.restarts = -1;
  EXPECT_FALSE(NumericIk::create(arm, several));
}

}  // namespace
}  // namespace saccade
