// SPDX-License-Identifier: Apache-2.0
// saccade-ros2 joints: an arm behind a joint_trajectory_controller of an independent implementation.
#include <gtest/gtest.h>

#include "fast_robot.hpp"
#include "ros2_programs.hpp"

namespace saccade::test {
namespace {

const std::vector<std::string> kNames{"shoulder", "elbow", "wrist"};

ProgramJointsConfig config_of(const std::string& more = "") {
  ProgramJointsConfig config;
  config.program.command = ros2_command("joints /arm_controller/joint_trajectory " + more);
  config.names = kNames;
  config.lower = Configuration::Constant(3, -3.0);
  config.upper = Configuration::Constant(3, 3.0);
  config.speed = Configuration::Constant(3, 2.0);
  config.acceleration = Configuration::Constant(3, 4.0);
  return config;
}

/// Speeds up for half of the time and slows down for the other half.
Trajectory motion(const Configuration& from, const Configuration& to, double duration_s) {
  const double half_s = 0.5 * duration_s;
  const Configuration acceleration = (to - from) / (half_s * half_s);
  const Configuration rest = Configuration::Zero(from.size());
  return Trajectory{{{half_s, from, rest, acceleration},
                     {half_s, 0.5 * (from + to), half_s * acceleration, -acceleration},
                     {0.0, to, rest, rest}}};
}

struct StartedJoints {
  FastNode node;
  FastArm arm{node, kNames, {0.1, -0.2, 0.3}};
  Result<std::unique_ptr<ProgramJoints>> joints{ProgramJoints::start(config_of())};
};

TEST(Ros2Joints, FollowAMotionByNameAndTellPositionsOnTheWay) {
  StartedJoints s;
  ASSERT_TRUE(s.joints) << s.joints.error().to_string();
  const auto start = (*s.joints)->position();
  ASSERT_TRUE(start) << start.error().to_string();
  EXPECT_EQ(*start, (Configuration{{0.1, -0.2, 0.3}}));
  const Configuration goal{{0.3, -0.5, 0.3}};
  int samples = 0;
  std::optional<double> time_s;
  const auto arrival = (*s.joints)->execute(motion(*start, goal, 0.6), [&](const JointSample& sample) {
    ++samples;
    time_s = sample.time_s;
    return Advance::go_on;
  });
  ASSERT_TRUE(arrival) << arrival.error().to_string();
  EXPECT_FALSE(arrival->stopped);
  EXPECT_LT((arrival->q - goal).lpNorm<Eigen::Infinity>(), 1e-3);
  EXPECT_GT(samples, 15);
  EXPECT_NEAR(time_s.value_or(0.0), wall_s(), 1.0);
  const std::vector<FastTrajectory> heard = s.arm.heard();
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_EQ(heard[0].joint_names_(), kNames);
  EXPECT_EQ(heard[0].points_().back().positions_(), (std::vector<double>{0.3, -0.5, 0.3}));
  EXPECT_EQ(heard[0].points_().back().time_from_start_().nanosec_(), 600000000U);
  EXPECT_EQ(heard[0].points_()[1].velocities_().size(), 3U);
}

TEST(Ros2Joints, StopIsATrajectoryOfOnePoint) {
  StartedJoints s;
  ASSERT_TRUE(s.joints) << s.joints.error().to_string();
  const Configuration start = (*s.joints)->position().value();
  const auto arrival =
      (*s.joints)->execute(motion(start, Configuration{{1.1, -0.2, 0.3}}, 2.0),
                           [](const JointSample& sample) { return sample.t_s > 0.5 ? Advance::stop : Advance::go_on; });
  ASSERT_TRUE(arrival) << arrival.error().to_string();
  EXPECT_TRUE(arrival->stopped);
  EXPECT_GT(arrival->q[0], 0.11);
  EXPECT_LT(arrival->q[0], 0.4);
  EXPECT_NEAR(arrival->q[0], s.arm.q()[0], 1e-3);
  const std::vector<FastTrajectory> heard = s.arm.heard();
  ASSERT_EQ(heard.size(), 2U);
  EXPECT_EQ(heard[1].points_().size(), 1U);
  EXPECT_EQ((*s.joints)->position().value()[0], arrival->q[0]);
}

TEST(Ros2Joints, StatesThatStopOnTheWayStopTheArm) {
  StartedJoints s;
  ASSERT_TRUE(s.joints) << s.joints.error().to_string();
  const Configuration start = (*s.joints)->position().value();
  const auto arrival =
      (*s.joints)->execute(motion(start, Configuration{{1.1, -0.2, 0.3}}, 2.0), [&](const JointSample& sample) {
        if (sample.t_s > 0.3) s.arm.silent = true;
        return Advance::go_on;
      });
  ASSERT_FALSE(arrival);
  EXPECT_NE(arrival.error().to_string().find("/joint_states has been silent for"), std::string::npos)
      << arrival.error().to_string();
  ASSERT_TRUE(eventually([&] { return s.arm.heard().size() > 1; }));
  const FastTrajectory hold = s.arm.heard()[1];
  EXPECT_EQ(hold.points_().size(), 1U);
  EXPECT_LT(hold.points_()[0].positions_()[0], 0.9);
}

TEST(Ros2Joints, AControllerThatRefusesAndWhatIsMissingAreSaid) {
  StartedJoints s;
  ASSERT_TRUE(s.joints) << s.joints.error().to_string();
  const Configuration start = (*s.joints)->position().value();
  s.arm.refuses = true;
  const auto arrival = (*s.joints)->execute(motion(start, Configuration{{0.5, -0.2, 0.3}}, 0.5));
  ASSERT_FALSE(arrival);
  EXPECT_NE(arrival.error().to_string().find("off the trajectory"), std::string::npos) << arrival.error().to_string();
  ProgramJointsConfig config = config_of("--wait 1");
  config.names = {"shoulder", "elbow", "tilt"};
  const auto other = ProgramJoints::start(config);
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().to_string().find("/joint_states does not tell the positions of tilt"), std::string::npos)
      << other.error().to_string();
  config = config_of("--wait 1");
  config.program.command = ros2_command("joints /other_controller/joint_trajectory --wait 1");
  const auto none = ProgramJoints::start(config);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().to_string().find("nothing listens on /other_controller"), std::string::npos)
      << none.error().to_string();
}

}  // namespace
}  // namespace saccade::test
