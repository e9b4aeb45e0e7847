// SPDX-License-Identifier: Apache-2.0
#include "saccade/robot/joint_controller.hpp"

#include "saccade/arm/motion_planner.hpp"

#include <gtest/gtest.h>

#include "support/test_arms.hpp"

namespace saccade {
namespace {

TEST(SimulatedJoints, FollowATrajectoryAndStandAtItsEnd) {
  const ArmModel arm = test::with_camera(test::describe("comau", test::comau_rows()));
  const Configuration from = arm.middle();
  Configuration to = from;
  to[0] += 0.2;
  const Trajectory trajectory = parametrise(arm, {from, to});
  SimulatedJoints joints{from};
  std::vector<JointSample> samples;
  const auto end = joints.execute(trajectory, [&](const JointSample& sample) {
    samples.push_back(sample);
    return Advance::go_on;
  });
  ASSERT_TRUE(end);
  EXPECT_EQ(end->q, trajectory.end());
  EXPECT_FALSE(end->stopped);
  EXPECT_EQ(joints.position().value(), trajectory.end());
  ASSERT_GT(samples.size(), 5U);
  EXPECT_EQ(samples.front().q, from);
  EXPECT_EQ(samples.back().t_s, trajectory.duration_s());
  for (std::size_t i = 1; i < samples.size(); ++i) {
    EXPECT_GT(samples[i].t_s, samples[i - 1].t_s);
    EXPECT_LE(samples[i].t_s - samples[i - 1].t_s, SimulatedJoints::kSample_s + 1e-12);
  }
  // The observer may stop them.
  const Trajectory back = parametrise(arm, {to, from});
  const auto stopped = joints.execute(
      back, [&](const JointSample& sample) { return sample.t_s < 0.1 ? Advance::go_on : Advance::stop; });
  ASSERT_TRUE(stopped);
  EXPECT_TRUE(stopped->stopped);
  EXPECT_EQ(stopped->q, back.at(0.1).q);
  EXPECT_EQ(joints.position().value(), stopped->q);
}

}  // namespace
}  // namespace saccade
