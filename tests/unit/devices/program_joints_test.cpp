// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include "saccade/arm/motion_planner.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/devices/programs.hpp"
#include "support/places.hpp"
#include "support/shared_arms.hpp"
#include "support/temp_folder.hpp"
#include "support/test_arms.hpp"

namespace saccade {
namespace {

const ArmModel& comau() {
  static const ArmModel arm = test::with_camera(test::describe("comau", test::comau_rows()));
  return arm;
}

ProgramJointsConfig joints_config(const std::string& command) {
  ProgramJointsConfig config;
  config.program.command = command;
  config.lower = config.upper = config.speed = config.acceleration = Configuration::Zero(comau().dof());
  for (int i = 0; i < comau().dof(); ++i) {
    const ArmJoint& joint = comau().joints()[static_cast<std::size_t>(i)];
    config.names.push_back(joint.name);
    config.lower[i] = joint.limits.lower;
    config.upper[i] = joint.limits.upper;
    config.speed[i] = joint.limits.speed;
    config.acceleration[i] = joint.limits.acceleration;
  }
  return config;
}

std::string joints_py(const std::string& rate) {
  return "/usr/bin/python3 -B '" + (test::source_folder() / "devices/joints.py").string() + "' " + rate;
}

std::string joints_cpp(const std::string& rate) {
  return "'" + test::device_program("joints-example").string() + "' " + rate;
}

Trajectory turn(const Configuration& from, double angle_rad) {
  Configuration to = from;
  to[0] += angle_rad;
  return parametrise(comau(), {from, to});
}

/// Joints that answer hello and joints in order, and a motion by a line of Python.
class BadJoints {
 public:
  explicit BadJoints(const std::string& on_follow) {
    std::ofstream{script()} << "import json, sys, time\n"
                               "heard = open(sys.argv[1], 'w')\n"
                               "def say(**message): print(json.dumps(message), flush=True)\n"
                               "for line in sys.stdin:\n"
                               "    r = json.loads(line)\n"
                               "    print(r['request'], file=heard, flush=True)\n"
                               "    n = r.get('number')\n"
                               "    if r['request'] == 'hello':\n"
                               "        say(saccade=1)\n"
                               "        q = [0.5 * (a + b) for a, b in zip(r['lower'], r['upper'])]\n"
                               "    elif r['request'] == 'joints': say(number=n, q=q)\n"
                               "    elif r['request'] == 'stop': say(number=n, q=q)\n"
                               "    else:\n"
                               "        points = r['points']\n"
                               "        "
                            << on_follow << "\n";
  }
  [[nodiscard]] std::string command() const { return "/usr/bin/python3 -B '" + script() + "' '" + heard() + "'"; }
  /// The requests that it has read.
  [[nodiscard]] std::string requests() const { return test::text_of_file(heard()); }

 private:
  [[nodiscard]] std::string script() const { return (folder_ / "joints.py").string(); }
  [[nodiscard]] std::string heard() const { return (folder_ / "heard").string(); }
  test::TempFolder folder_;
};

void expect_to_follow(const std::string& command) {
  auto joints = ProgramJoints::start(joints_config(command));
  ASSERT_TRUE(joints.ok()) << joints.error().to_string();
  const Configuration from = (*joints)->position().value();
  EXPECT_LT((from - comau().middle()).norm(), 1e-12);
  const Trajectory trajectory = turn(from, 0.5);
  std::vector<JointSample> samples;
  const auto end = (*joints)->execute(trajectory, [&](const JointSample& sample) {
    samples.push_back(sample);
    return Advance::go_on;
  });
  ASSERT_TRUE(end.ok()) << end.error().to_string();
  EXPECT_FALSE(end->stopped);
  EXPECT_LT((end->q - trajectory.end()).norm(), 1e-9);
  EXPECT_LT(((*joints)->position().value() - trajectory.end()).norm(), 1e-9);
  ASSERT_GE(samples.size(), 3U);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    EXPECT_GT(samples[i].t_s, samples[i - 1].t_s);
    EXPECT_GE(samples[i].time_s.value(), samples[i - 1].time_s.value());
    EXPECT_LT((samples[i].q - trajectory.at(samples[i].t_s).q).norm(), 2e-3);  // straight between its points
  }
}

TEST(ProgramJoints, TheExamplesFollowATrajectory) {
  expect_to_follow(joints_py("4"));
  if (std::filesystem::exists(test::device_program("joints-example"))) expect_to_follow(joints_cpp("4"));
}

void expect_to_stop(const std::string& command) {
  bool cancelled = false;
  ProgramJointsConfig config = joints_config(command);
  config.program.cancelled = [&] { return cancelled; };
  auto joints = ProgramJoints::start(config);
  ASSERT_TRUE(joints.ok()) << joints.error().to_string();
  const Configuration from = (*joints)->position().value();
  const Trajectory there = turn(from, 0.8);
  const auto stopped = (*joints)->execute(
      there, [&](const JointSample& sample) { return sample.q[0] > from[0] + 0.05 ? Advance::stop : Advance::go_on; });
  ASSERT_TRUE(stopped.ok()) << stopped.error().to_string();
  EXPECT_TRUE(stopped->stopped);
  EXPECT_LT(stopped->q[0], from[0] + 0.6);
  EXPECT_EQ((*joints)->position().value(), stopped->q);
  // It can move on from there.
  const Stopwatch watch;
  const auto again = (*joints)->execute(turn(stopped->q, -0.4), [&](const JointSample& sample) {
    cancelled = sample.t_s > 0.1;
    return Advance::go_on;
  });
  ASSERT_TRUE(again.ok()) << again.error().to_string();
  EXPECT_TRUE(again->stopped);
  cancelled = false;
  EXPECT_TRUE((*joints)->execute(turn(again->q, 0.01)).ok());
}

TEST(ProgramJoints, AnObserverOrACallerStopsThemOnTheWay) {
  expect_to_stop(joints_py("1"));
  if (std::filesystem::exists(test::device_program("joints-example"))) expect_to_stop(joints_cpp("1"));
}

TEST(ProgramJoints, WhateverIsWrongOnTheWayStopsTheArm) {
  const auto expect_stopped = [](const std::string& on_follow, Errc code, const std::string& words) {
    const BadJoints bad{on_follow};
    auto joints = ProgramJoints::start(joints_config(bad.command()));
    ASSERT_TRUE(joints.ok()) << joints.error().to_string();
    const Trajectory trajectory = turn((*joints)->position().value(), 0.8);
    const auto end = (*joints)->execute(trajectory);
    ASSERT_FALSE(end.ok()) << on_follow;
    EXPECT_EQ(end.error().code, code) << end.error().to_string();
    EXPECT_NE(end.error().message.find(words), std::string::npos) << end.error().to_string();
    EXPECT_NE(end.error().message.find("the arm was told to stop"), std::string::npos) << end.error().to_string();
    if (code == Errc::unavailable) return;  // it knows what it says
    EXPECT_FALSE((*joints)->position().ok());
  };
  const BadJoints silent{"pass"};
  auto unheard = ProgramJoints::start(joints_config(silent.command()));
  ASSERT_TRUE(unheard.ok());
  EXPECT_FALSE((*unheard)->execute(turn((*unheard)->position().value(), 0.8)).ok());
  EXPECT_NE(silent.requests().find("follow\nstop\n"), std::string::npos) << silent.requests();
  expect_stopped("pass", Errc::io_failure, "it has said nothing for");
  expect_stopped("say(number=n, done=False, t_s=0.1, q=[x + 0.2 for x in q])", Errc::corrupt_data,
                 "off the trajectory at 0.1 s");
  expect_stopped("say(number=n, done=True, q=q)", Errc::corrupt_data, "off the trajectory");
  expect_stopped("say(number=n + 5, done=True, q=q)", Errc::corrupt_data, "number must be 1, not 6");
  expect_stopped("say(number=n, q=q[:3])", Errc::corrupt_data, "q must be 6 numbers");
  expect_stopped("print('moving', flush=True)", Errc::corrupt_data, "it is not JSON: 'moving'");
  expect_stopped("say(error='joint 3 is overloaded')", Errc::unavailable, "joint 3 is overloaded");
  expect_stopped(
      "[(say(number=n, done=False, t_s=0.01 * i, q=q), time.sleep(0.01)) "
      "for i in range(150)]",
      Errc::corrupt_data, "off the trajectory");  // the arm does not move
}

TEST(ProgramJoints, AProgramThatHangsOrDiesOnTheWayIsNoticedAtOnce) {
  {
    const BadJoints bad{"sys.exit(3)"};
    auto joints = ProgramJoints::start(joints_config(bad.command()));
    ASSERT_TRUE(joints.ok());
    const auto end = (*joints)->execute(turn((*joints)->position().value(), 0.8));
    ASSERT_FALSE(end.ok());
    EXPECT_NE(end.error().message.find("exit status 3"), std::string::npos) << end.error().to_string();
  }
  const BadJoints bad{"time.sleep(100)"};
  auto joints = ProgramJoints::start(joints_config(bad.command()));
  ASSERT_TRUE(joints.ok());
  const Trajectory trajectory = turn((*joints)->position().value(), 0.8);
  const Stopwatch watch;
  const auto end = (*joints)->execute(trajectory);
  ASSERT_FALSE(end.ok());
  joints->reset();
  EXPECT_LT(watch.elapsed_ms(), 3000.0);  // the watchdog, the word to stop, and the end of the program
}

TEST(ProgramJoints, AProgramWhoseOutputEndsOrMakesNoSenseIsToldToStop) {
  for (const std::string on_follow : {"sys.stdout.flush(); import os; os.close(1)", "print('x' * 70000, flush=True)"}) {
    const BadJoints bad{on_follow};
    auto joints = ProgramJoints::start(joints_config(bad.command()));
    ASSERT_TRUE(joints.ok()) << joints.error().to_string();
    const auto end = (*joints)->execute(turn((*joints)->position().value(), 0.8));
    ASSERT_FALSE(end.ok()) << on_follow;
    EXPECT_NE(end.error().message.find("the arm was told to stop"), std::string::npos) << end.error().to_string();
    joints->reset();
    EXPECT_NE(bad.requests().find("follow\nstop\n"), std::string::npos) << on_follow << ": " << bad.requests();
  }
}

TEST(ProgramJoints, PositionsOutsideTheLimitsAreAnError) {
  const BadJoints bad{"pass"};
  ProgramJointsConfig config = joints_config(bad.command());
  config.upper[2] = config.lower[2] - 1.0;  // what the program takes the middle of is outside then
  auto joints = ProgramJoints::start(config);
  ASSERT_TRUE(joints.ok());
  const auto q = (*joints)->position();
  ASSERT_FALSE(q.ok());
  EXPECT_NE(q.error().message.find("outside its limits"), std::string::npos) << q.error().to_string();
}

}  // namespace
}  // namespace saccade
