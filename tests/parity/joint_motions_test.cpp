// SPDX-License-Identifier: Apache-2.0
// Motions that are planned here and made by a program: what the arm reports on the way lies on the plan, within its
// limits, and FCL finds it touching nothing.
#include <gtest/gtest.h>

#include <filesystem>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "saccade/arm/motion_planner.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/devices/programs.hpp"
#include "support/effort.hpp"
#include "support/fcl_arm.hpp"
#include "support/places.hpp"
#include "support/shared_arms.hpp"
#include "support/test_arms.hpp"
#include "support/trajectory_checks.hpp"

namespace saccade::test {
namespace {

/// Results of the motions of one arm.
struct MotionFigures {
  std::size_t motions{0};
  std::size_t detours{0};  ///< not straight in joint space
  std::size_t samples{0};  ///< that the program reported
  std::size_t beyond_limits{0};
  std::size_t contacts{0};    ///< by FCL, at samples and every 10 ms of the plans
  double farthest_off{0.0};   ///< distance of a sample from the plan, rad
  double fastest_share{0.0};  ///< share of the speed limit, between two samples
  double hardest_share{0.0};  ///< share of the acceleration limit, between the points that are sent
};

ProgramJointsConfig config_of(const ArmModel& arm, const Configuration& start, double rate) {
  ProgramJointsConfig config;
  std::ostringstream command;
  command << '\'' << (std::filesystem::path{saccade_program()}.parent_path() / "saccade-simulated-arm").string()
          << "' --rate " << rate << std::setprecision(17) << " --start ";
  for (Eigen::Index i = 0; i < start.size(); ++i) command << (i > 0 ? "," : "") << start[i];
  config.program.command = command.str();
  config.watchdog_s = 2.0;  // other tests run beside this one
  config.lower = config.upper = config.speed = config.acceleration = Configuration::Zero(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) {
    config.names.push_back(arm.joint(i).name);
    config.lower[i] = arm.joint(i).limits.lower;
    config.upper[i] = arm.joint(i).limits.upper;
    config.speed[i] = arm.joint(i).limits.speed;
    config.acceleration[i] = arm.joint(i).limits.acceleration;
  }
  return config;
}

/// A table, and a dozen boxes within reach.
ObstacleMap boxes_around(const Eigen::Vector3d& shoulder, std::mt19937_64& random) {
  TsdfConfig config;
  config.voxel_size_m = 0.02;
  config.workspace = Box{shoulder - Eigen::Vector3d{1.5, 1.5, 0.6}, shoulder + Eigen::Vector3d{1.5, 1.5, 1.5}};
  TsdfMap map = TsdfMap::create(config).value();
  SACCADE_EXPECTS(map.free(*config.workspace).ok());
  const auto within = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  };
  ObstacleConfig obstacles;
  obstacles.fixtures = {Box{shoulder + Eigen::Vector3d{0.4, -1.0, -0.6}, shoulder + Eigen::Vector3d{1.4, 1.0, -0.3}}};
  while (obstacles.fixtures.size() < 13) {
    const Eigen::Vector3d at{within(-1.1, 1.1), within(-1.1, 1.1), within(-0.4, 1.0)};
    if (at.head<2>().norm() < 0.5) continue;
    const Eigen::Vector3d half{within(0.03, 0.15), within(0.03, 0.15), within(0.03, 0.15)};
    obstacles.fixtures.push_back({shoulder + at - half, shoulder + at + half});
  }
  return ObstacleMap::create(map.snapshot(), obstacles, Executor{}).value();
}

class ManyMotions {
 public:
  ManyMotions(const ArmModel& arm, std::uint64_t seed, double rate)
      : arm_{arm},
        collision_{ArmCollision::create(arm).value()},
        planner_{MotionPlanner::create(collision_).value()},
        random_{seed},
        obstacles_{boxes_around(forward_kinematics(arm, arm.middle()).T_world_link[1].translation(), random_)},
        fcl_{collision_, obstacles_},
        q_{some_free()},
        joints_{ProgramJoints::start(config_of(arm, q_, rate)).value()} {}

  [[nodiscard]] MotionFigures make(std::size_t count) {
    while (figures_.motions < count) move();
    return figures_;
  }

 private:
  [[nodiscard]] Configuration some_free() {
    for (;;) {
      Configuration q = random_configuration(arm_, random_);
      // Within half a turn of the middle: most motions would be whole turns otherwise.
      constexpr double kHalfTurn{3.0};
      q = arm_.middle() + (q - arm_.middle()).cwiseMax(-kHalfTurn).cwiseMin(kHalfTurn);
      if (!collision_.contact(q, obstacles_)) return q;
    }
  }

  void move() {
    const Configuration goal = some_free();
    const auto outcome = planner_.plan(q_, std::span{&goal, 1}, obstacles_);
    ASSERT_TRUE(outcome.ok()) << outcome.error().to_string();
    if (!outcome->plan) return;
    const Trajectory& planned = outcome->plan->trajectory;
    expect_sound(arm_, outcome->plan->path, planned);
    ++figures_.motions;
    figures_.detours += outcome->plan->path.size() > 2 ? 1 : 0;
    check_points(planned);
    JointSample before{0.0, q_, {}};
    const auto arrival = joints_->execute(planned, [&](const JointSample& sample) {
      check(sample, before, planned);
      before = sample;
      return Advance::go_on;
    });
    ASSERT_TRUE(arrival.ok()) << arrival.error().to_string();
    ASSERT_FALSE(arrival->stopped);
    ASSERT_LT((arrival->q - planned.end()).lpNorm<Eigen::Infinity>(), 1e-9);
    q_ = arrival->q;
  }

  /// The points 20 ms apart that a program is sent, and the plan between them.
  void check_points(const Trajectory& planned) {
    constexpr double kPoint_s{0.02};
    constexpr double kFine_s{0.01};
    Configuration speed_before = Configuration::Zero(arm_.dof());
    for (double t_s = kPoint_s; t_s < planned.duration_s(); t_s += kPoint_s) {
      const Configuration speed = planned.at(t_s).speed;
      for (int i = 0; i < arm_.dof(); ++i) {
        const double share = std::fabs(speed[i] - speed_before[i]) / kPoint_s / arm_.joint(i).limits.acceleration;
        figures_.hardest_share = std::max(figures_.hardest_share, share);
        figures_.beyond_limits += share > 1.0 + 1e-6 ? 1 : 0;
      }
      speed_before = speed;
    }
    for (double t_s = 0.0; t_s < planned.duration_s(); t_s += kFine_s) {
      figures_.contacts += fcl_.collides(forward_kinematics(arm_, planned.at(t_s).q)) ? 1 : 0;
    }
  }

  void check(const JointSample& sample, const JointSample& before, const Trajectory& planned) {
    ++figures_.samples;
    const Configuration wanted = planned.at(std::min(sample.t_s, planned.duration_s())).q;
    figures_.farthest_off = std::max(figures_.farthest_off, (sample.q - wanted).lpNorm<Eigen::Infinity>());
    for (int i = 0; i < arm_.dof(); ++i) {
      const JointLimits& limits = arm_.joint(i).limits;
      figures_.beyond_limits += sample.q[i] < limits.lower - 1e-9 || sample.q[i] > limits.upper + 1e-9 ? 1 : 0;
      const double step_s = sample.t_s - before.t_s;
      if (step_s < 1e-3) continue;
      const double share = std::fabs(sample.q[i] - before.q[i]) / step_s / limits.speed;
      figures_.fastest_share = std::max(figures_.fastest_share, share);
      figures_.beyond_limits += share > 1.0 + 1e-3 ? 1 : 0;
    }
    figures_.contacts += fcl_.collides(forward_kinematics(arm_, sample.q)) ? 1 : 0;
  }

  const ArmModel& arm_;
  ArmCollision collision_;
  MotionPlanner planner_;
  std::mt19937_64 random_;
  ObstacleMap obstacles_;
  FclArm fcl_;
  Configuration q_;
  std::unique_ptr<ProgramJoints> joints_;
  MotionFigures figures_;
};

void expect_motions(const ArmModel& arm, std::size_t count, double rate) {
  const MotionFigures figures = ManyMotions{arm, 1, rate}.make(count);
  EXPECT_EQ(figures.motions, count);
  EXPECT_EQ(figures.beyond_limits, 0U);
  EXPECT_EQ(figures.contacts, 0U);
  EXPECT_GT(figures.samples, count);
  EXPECT_LT(figures.farthest_off, 1e-3);
  EXPECT_GT(figures.fastest_share, 0.9);
  std::cout << arm.name() << ": " << figures.motions << " motions, " << figures.detours << " with a detour, "
            << figures.samples << " positions reported, at most " << 1e3 * figures.farthest_off
            << " mrad off the plan; at most " << 100.0 * figures.fastest_share << " % of the speeds and "
            << 100.0 * figures.hardest_share << " % of the accelerations; " << figures.beyond_limits
            << " times beyond a limit, " << figures.contacts << " contacts by FCL\n";
}

ArmModel builtin(const char* name) { return find_robot(name).value().arm; }

constexpr std::size_t kMany{1000};
constexpr double kQuick{10.0};  ///< times real time

TEST(JointMotions, AProgramMovesAnArmAsPlanned) { expect_motions(builtin("ur_like"), 3, kQuick); }

TEST(JointMotionsEvidence, BuiltInArm) { expect_motions(builtin("comau"), kMany, kQuick); }
TEST(JointMotionsEvidence, UrLike) { expect_motions(builtin("ur_like"), kMany, kQuick); }
TEST(JointMotionsEvidence, Panda) {
  if (!std::filesystem::exists(shared_robots())) GTEST_SKIP() << "the recorded data are not there";
  expect_motions(shared_panda_hand().value().arm, kMany, kQuick);
}

}  // namespace
}  // namespace saccade::test
