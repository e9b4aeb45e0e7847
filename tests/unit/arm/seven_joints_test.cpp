// SPDX-License-Identifier: Apache-2.0
// Inverse kinematics in closed form of arms with seven joints, whose poses leave one value open.
#include <gtest/gtest.h>

#include "saccade/arm/internal/joint_axes.hpp"
#include "saccade/arm/inverse_kinematics.hpp"
#include "saccade/arm/kinematics.hpp"
#include "support/effort.hpp"
#include "support/test_arms.hpp"

namespace saccade {
namespace {

using std::numbers::pi;

struct SevenJoints {
  std::string name;
  ArmDescription description;
  IkRedundancy redundancy;
};

void PrintTo(const SevenJoints& arm, std::ostream* out) { *out << arm.name; }

SevenJoints joints_of(const std::string& name, const std::vector<test::DhRow>& rows, IkRedundancy redundancy) {
  return {name, test::describe(name, rows), redundancy};
}

/// An arm with six joints on a rail, and on a turntable.
SevenJoints on_rail() {
  return {"on_rail",
          test::on_joint(test::describe("comau", test::comau_rows()), JointKind::prismatic, {0.6, 0.8, 0.0}, -1.0, 1.5),
          IkRedundancy::first_joint};
}

SevenJoints on_turntable() {
  return {"on_turntable",
          test::on_joint(test::describe("ur", test::ur_rows()), JointKind::continuous, {0.0, 0.1, 1.0}, 0.0, 0.0),
          IkRedundancy::first_joint};
}

InverseKinematics solver_of(ArmDescription description, int samples = IkConfig{}.redundancy_samples) {
  IkConfig config;
  config.redundancy_samples = samples;
  config.max_turns = 16;
  return InverseKinematics::create(test::with_camera(std::move(description)), config).value();
}

void expect_solutions(const InverseKinematics& ik, const std::vector<Configuration>& solutions, const Pose& T) {
  for (const Configuration& q : solutions) {
    ASSERT_TRUE(ik.arm().within_limits(q)) << q.transpose();
    ASSERT_LT(test::miss(camera_pose(ik.arm(), q), T), kIkTolerance) << q.transpose();
  }
}

class ClosedFormOfSeven : public testing::TestWithParam<SevenJoints> {};

TEST_P(ClosedFormOfSeven, FindsTheReferenceAgain) {
  const InverseKinematics ik = solver_of(GetParam().description, 4);
  ASSERT_EQ(ik.method(), IkMethod::closed_form) << ik.why_numeric();
  EXPECT_EQ(ik.redundancy(), GetParam().redundancy);
  EXPECT_FALSE(ik.refines());
  std::mt19937_64 random{21};
  double worst = 0.0;
  for (int i = 0; i < test::scaled_cases(5000); ++i) {
    const Configuration q = test::random_configuration(ik.arm(), random);
    const Pose T = camera_pose(ik.arm(), q);
    const std::vector<Configuration> solutions = ik.solve(T, q);
    expect_solutions(ik, solutions, T);
    worst = std::max(worst, test::nearest(solutions, q));
  }
  EXPECT_LT(worst, 1e-5);  // next to singular poses a joint moves far while the camera does not
}

TEST_P(ClosedFormOfSeven, FindsNothingTwice) {
  const InverseKinematics ik = solver_of(GetParam().description, 5);
  std::mt19937_64 random{22};
  for (int i = 0; i < test::scaled_cases(500); ++i) {
    const Pose T = camera_pose(ik.arm(), test::random_configuration(ik.arm(), random));
    const std::vector<Configuration> solutions = ik.solve(T);
    for (std::size_t a = 0; a < solutions.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) ASSERT_GT(test::distance(solutions[a], solutions[b]), 1e-9);
    }
  }
}

TEST_P(ClosedFormOfSeven, FindsNothingBeyondTheReach) {
  const InverseKinematics ik = solver_of(GetParam().description);
  std::mt19937_64 random{23};
  for (int i = 0; i < test::scaled_cases(500); ++i) {
    Pose T = camera_pose(ik.arm(), test::random_configuration(ik.arm(), random));
    const Eigen::Vector3d base = ik.arm().T_world_base().translation();
    T.translation() = base + 1.5 * (T.translation() - base);
    expect_solutions(ik, ik.solve(T), T);
  }
  for (const double x : {100.0, std::numeric_limits<double>::quiet_NaN()}) {
    Pose far = Pose::Identity();
    far.translation().x() = x;
    EXPECT_TRUE(ik.solve(far).empty());
  }
}

TEST_P(ClosedFormOfSeven, SolvesStraightElbowsShouldersAndWrists) {
  const InverseKinematics ik = solver_of(GetParam().description, 4);
  std::mt19937_64 random{24};
  int cases = 0;
  for (int i = 0; i < test::scaled_cases(100); ++i) {
    const Configuration q = test::random_configuration(ik.arm(), random);
    for (const double near : {0.0, 1e-12, 1e-9, 1e-7, 1e-4}) {
      for (const double angle : {0.0, 0.5 * pi, -0.5 * pi, pi}) {
        for (const int joint : {1, 3, 5}) {
          Configuration singular = q;
          const JointLimits& limits = ik.arm().joint(joint).limits;
          singular[joint] = std::clamp(angle + near, limits.lower, limits.upper);
          const Pose T = camera_pose(ik.arm(), singular);
          const std::vector<Configuration> solutions = ik.solve(T, singular);
          ASSERT_FALSE(solutions.empty()) << singular.transpose();
          expect_solutions(ik, solutions, T);
          ++cases;
        }
      }
    }
  }
  EXPECT_EQ(cases, 60 * test::scaled_cases(100));
}

TEST_P(ClosedFormOfSeven, AnyOfStopsAtTheFirstThatPasses) {
  const InverseKinematics ik = solver_of(GetParam().description);
  std::mt19937_64 random{25};
  std::size_t most = 0;
  for (int i = 0; i < 50; ++i) {
    const Configuration q = test::random_configuration(ik.arm(), random);
    const Pose T = camera_pose(ik.arm(), q);
    const std::vector<Configuration> solutions = ik.solve(T, q);
    ASSERT_FALSE(solutions.empty());
    most = std::max(most, solutions.size());
    std::vector<Configuration> tried;
    const auto try_up_to = [&](std::size_t count) {
      tried.clear();
      return ik.any_of(T, q, [&](const Configuration& solution) {
        tried.push_back(solution);
        return tried.size() == count;
      });
    };
    EXPECT_FALSE(try_up_to(0));
    EXPECT_EQ(tried, solutions);
    const std::size_t half = (solutions.size() + 1) / 2;
    EXPECT_TRUE(try_up_to(half));
    EXPECT_EQ(tried.size(), half);
  }
  EXPECT_GT(most, 24U);
}

INSTANTIATE_TEST_SUITE_P(Arms, ClosedFormOfSeven,
                         testing::Values(joints_of("panda", test::panda_rows(), IkRedundancy::last_joint),
                                         joints_of("oblique_panda", test::oblique_panda_rows(),
                                                   IkRedundancy::last_joint),
                                         joints_of("iiwa", test::iiwa_rows(), IkRedundancy::swivel),
                                         joints_of("oblique_iiwa", test::oblique_iiwa_rows(), IkRedundancy::swivel),
                                         on_rail(), on_turntable()),
                         [](const auto& each) { return each.param.name; });

/// From the middle of the limits, as when nothing is known of the configuration.
TEST(SevenJoints, WhatIterationSolvesTheClosedFormSolves) {
  struct Case {
    std::vector<test::DhRow> rows;
    double share;  ///< least share of the poses
  };
  for (const Case& each : {Case{test::panda_rows(), 0.99}, Case{test::iiwa_rows(), 0.999}}) {
    const ArmModel arm = test::with_camera(test::describe("arm", each.rows));
    IkConfig config;
    config.method = IkMethod::numeric;
    const InverseKinematics numeric = InverseKinematics::create(arm, config).value();
    EXPECT_EQ(numeric.redundancy(), IkRedundancy::none);
    const InverseKinematics closed = InverseKinematics::create(arm).value();
    std::mt19937_64 random{26};
    const int cases = test::scaled_cases(1000);
    int solved = 0;
    int both = 0;
    for (int i = 0; i < cases; ++i) {
      const Pose T = camera_pose(arm, test::random_configuration(arm, random));
      if (numeric.solve(T).empty()) continue;
      ++solved;
      both += closed.any_of(T, arm.middle(), [](const Configuration&) { return true; }) ? 1 : 0;
    }
    EXPECT_GE(solved, cases * 98 / 100);
    EXPECT_GE(both, each.share * solved);
  }
}

TEST(SevenJoints, TheHeldJointKeepsItsLimits) {
  ArmDescription description = test::describe("panda", test::panda_rows());
  description.joints[6].limits.lower = 0.3;
  description.joints[6].limits.upper = 0.4;
  const InverseKinematics ik = solver_of(std::move(description));
  std::mt19937_64 random{27};
  for (int i = 0; i < test::scaled_cases(500); ++i) {
    const Configuration q = test::random_configuration(ik.arm(), random);
    const Pose T = camera_pose(ik.arm(), q);
    Configuration reference = q;
    reference[6] = -2.0;  // is put on the limit
    expect_solutions(ik, ik.solve(T, reference), T);
    EXPECT_LT(test::nearest(ik.solve(T, q), q), 1e-5);
  }
}

TEST(SevenJoints, MoreSamplesGiveMoreSolutions) {
  for (const auto& rows : {test::panda_rows(), test::iiwa_rows()}) {
    const ArmDescription description = test::describe("arm", rows);
    const InverseKinematics few = solver_of(description, 4);
    const InverseKinematics many = solver_of(description, 40);
    const Configuration q = few.arm().middle() + Configuration::Constant(7, 0.3);
    const Pose T = camera_pose(few.arm(), q);
    EXPECT_GT(many.solve(T, q).size(), 2 * few.solve(T, q).size());
  }
  IkConfig none;
  none.redundancy_samples = 0;
  const auto refused = InverseKinematics::create(test::with_camera(test::describe("panda", test::panda_rows())), none);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::invalid_argument);
}

TEST(SevenJoints, RefinesForArmsThatWereRoundedOff) {
  for (const auto& rows : {test::panda_rows(), test::iiwa_rows()}) {
    std::vector<test::DhRow> rounded = rows;
    for (test::DhRow& row : rounded) row.alpha_rad = std::round(1e4 * row.alpha_rad) / 1e4;  // 1.5708
    for (test::DhRow& row : rounded) row.a_m += row.a_m == 0.0 ? 1e-6 : 0.0;
    const InverseKinematics ik = solver_of(test::describe("arm", rounded));
    ASSERT_EQ(ik.method(), IkMethod::closed_form) << ik.why_numeric();
    EXPECT_TRUE(ik.refines());
    std::mt19937_64 random{28};
    int again = 0;
    for (int i = 0; i < test::scaled_cases(1000); ++i) {
      const Configuration q = test::random_configuration(ik.arm(), random);
      const Pose T = camera_pose(ik.arm(), q);
      const std::vector<Configuration> solutions = ik.solve(T, q);
      expect_solutions(ik, solutions, T);
      again += test::nearest(solutions, q) < 0.05 ? 1 : 0;  // refining moves the value that is held, too
    }
    EXPECT_GE(again, test::scaled_cases(1000) * 99 / 100);
  }
}

TEST(SevenJoints, ABatchIsItsPosesOneByOneForAnyThreadCount) {
  const InverseKinematics ik = solver_of(test::describe("panda", test::panda_rows()), 6);
  std::mt19937_64 random{29};
  std::vector<Pose> poses;
  for (int i = 0; i < 1200; ++i) poses.push_back(camera_pose(ik.arm(), test::random_configuration(ik.arm(), random)));
  const IkTable one = ik.solve_all(poses, ik.arm().middle(), {});
  const IkTable many = ik.solve_all(poses, ik.arm().middle(), Executor::with_threads(3));
  EXPECT_EQ(one.dof, 7);
  EXPECT_EQ(one.first, many.first);
  EXPECT_EQ(one.values, many.values);
  for (std::size_t i = 0; i < poses.size(); i += 100) {
    const std::vector<Configuration> alone = ik.solve(poses[i]);
    ASSERT_EQ(alone.size(), one.count(i));
    for (std::size_t k = 0; k < alone.size(); ++k) EXPECT_EQ(alone[k], one.solution(i, k));
  }
}

TEST(SevenJoints, SaysWhyThereIsNoClosedForm) {
  ArmDescription description = test::describe("panda", test::panda_rows());
  description.joints[2].T_parent_joint.translation().x() += 0.01;
  const InverseKinematics ik = InverseKinematics::create(ArmModel::create(description).value()).value();
  EXPECT_EQ(ik.method(), IkMethod::numeric);
  EXPECT_EQ(ik.why_numeric(), "no closed form: neither the first six nor the last six of its seven joints have one");
}

TEST(SpreadOver, CoversARangeEvenlyAndEarly) {
  std::vector<double> values = spread_over(-1.0, 3.0, 8);
  ASSERT_EQ(values.size(), 8U);
  const auto [low, high] = std::minmax({values[0], values[1], values[2]});
  EXPECT_GT(high - low, 1.5);
  std::sort(values.begin(), values.end());
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(values[i], -0.75 + 0.5 * static_cast<double>(i), 1e-12);
  EXPECT_EQ(spread_over(2.0, 4.0, 1), std::vector<double>{3.0});
}

}  // namespace
}  // namespace saccade
