// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/detector_evaluation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "saccade/attention/internal/hand_smoothing.hpp"
#include "saccade/trial/simulated_task.hpp"

namespace saccade {
namespace {

HandTrajectory straight_way(int samples) {
  HandTrajectory trajectory;
  for (int i = 0; i < samples; ++i) {
    const Eigen::Quaterniond turned{Eigen::AngleAxisd{0.005 * i, Eigen::Vector3d::UnitZ()}};
    trajectory.push_back({5.0 + 0.01 * i, {0.02 * i, 1.0, 0.0}, turned});
  }
  return trajectory;
}

TEST(TrajectoryChanges, SpeedMultipliesSamplesAndKeepsTheInterval) {
  const HandTrajectory trajectory = straight_way(401);
  for (const double multiplier : {0.25, 0.5, 2.0, 4.0}) {
    const HandTrajectory changed = at_speed(trajectory, multiplier).value();
    ASSERT_EQ(changed.size(), static_cast<std::size_t>(400 * multiplier) + 1);
    EXPECT_EQ(changed.front().position_m, trajectory.front().position_m);
    EXPECT_NEAR((changed.back().position_m - trajectory.back().position_m).norm(), 0.0, 1e-12);
    for (std::size_t i = 0; i < changed.size(); ++i) {
      const double original = static_cast<double>(i) / multiplier;
      EXPECT_NEAR(changed[i].time_s, 5.0 + 0.01 * static_cast<double>(i), 1e-9);
      EXPECT_NEAR(changed[i].position_m.x(), 0.02 * original, 1e-9);
      EXPECT_NEAR(Eigen::AngleAxisd{*changed[i].R_world_hand}.angle(), 0.005 * original, 1e-9);
    }
  }
}

TEST(TrajectoryChanges, FasterHandsHaveOnlyPlacesThatWereSampled) {
  HandTrajectory trajectory = straight_way(8);
  for (std::size_t i = 1; i < 8; i += 2) trajectory[i].position_m.z() = 1.0;
  const HandTrajectory twice = at_speed(trajectory, 0.5).value();
  ASSERT_EQ(twice.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(twice[i].position_m, trajectory[2 * i].position_m);
  const HandTrajectory uneven = at_speed(trajectory, 0.4).value();
  ASSERT_EQ(uneven.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(uneven[i].position_m, trajectory[(5 * i) / 2].position_m);
}

TEST(TrajectoryChanges, OrientationsThatAreMissingStayMissing) {
  HandTrajectory trajectory = straight_way(5);
  trajectory[2].R_world_hand.reset();
  const HandTrajectory changed = at_speed(trajectory, 2.0).value();
  ASSERT_EQ(changed.size(), 9U);
  EXPECT_TRUE(changed[1].R_world_hand.has_value());
  EXPECT_FALSE(changed[3].R_world_hand.has_value());
  EXPECT_FALSE(changed[5].R_world_hand.has_value());
  EXPECT_TRUE(changed[7].R_world_hand.has_value());
}

TEST(TrajectoryChanges, ShortTrajectoriesAndBadMultipliers) {
  EXPECT_TRUE(at_speed({}, 4.0).value().empty());
  EXPECT_EQ(at_speed(straight_way(1), 4.0).value().size(), 1U);
  EXPECT_EQ(at_speed(straight_way(9), 0.01).value().size(), 1U);
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL, 1e12}) EXPECT_FALSE(at_speed(straight_way(9), bad));
}

TEST(TrajectoryChanges, NoiseHasItsDeviationAndFollowsTheSeed) {
  const HandTrajectory still(20000, HandSample{});
  const HandTrajectory noisy = with_noise(still, 0.05, 7).value();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const HandSample& sample : noisy) {
    mean += sample.position_m / 20000.0;
    squares += sample.position_m * sample.position_m.transpose() / 20000.0;
  }
  EXPECT_LT(mean.norm(), 0.002);
  EXPECT_LT((squares - 0.0025 * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_EQ(with_noise(still, 0.05, 7).value()[99].position_m, noisy[99].position_m);
  EXPECT_NE(with_noise(still, 0.05, 8).value()[99].position_m, noisy[99].position_m);
  EXPECT_EQ(with_noise(still, 0.0, 7).value()[99].position_m, still[99].position_m);
  EXPECT_FALSE(with_noise(still, -0.1, 7));
  EXPECT_FALSE(with_noise(still, HUGE_VAL, 7));
}

TEST(SyntheticTask, GoesWhereItSaysAndFollowsTheSeed) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const int actions = 1 + static_cast<int>(seed % 4);
    const SyntheticTask task = synthetic_task(seed, {.actions = actions});
    ASSERT_EQ(task.actions_m.size(), static_cast<std::size_t>(actions));
    for (const Eigen::Vector3d& place : task.actions_m) {
      int near{0};
      for (const HandSample& sample : task.trajectory) near += (sample.position_m - place).norm() < 0.05 ? 1 : 0;
      EXPECT_GT(near, 40) << "seed " << seed;
    }
    double longest_m{0.0};
    for (std::size_t i = 1; i < task.trajectory.size(); ++i) {
      EXPECT_NEAR(task.trajectory[i].time_s - task.trajectory[i - 1].time_s, 0.01, 1e-9);
      longest_m = std::max(longest_m, (task.trajectory[i].position_m - task.trajectory[i - 1].position_m).norm());
    }
    EXPECT_LT(longest_m, 0.15) << "seed " << seed;  // 3 m/s, and repeats before it
  }
  EXPECT_EQ(synthetic_task(4).trajectory.back().position_m, synthetic_task(4).trajectory.back().position_m);
  EXPECT_NE(synthetic_task(4).trajectory.back().position_m, synthetic_task(5).trajectory.back().position_m);
}

TEST(SyntheticTask, GoesToGivenPlacesAndPassesOverObstacles) {
  SyntheticHandPath way;
  way.outside_m = {0.0, 1.0, 0.3};
  way.places_m = {{-0.4, 0.0, 0.1}, {0.4, 0.0, 0.1}, {0.0, -0.3, 0.2}};
  way.obstacles = {{{-0.1, -0.1, 0.0}, {0.1, 0.1, 0.45}}, {{0.35, -0.05, 0.0}, {0.45, 0.05, 0.06}}};
  std::size_t over{0};
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const SyntheticTask task = synthetic_task(way, seed);
    EXPECT_EQ(task.actions_m, way.places_m);
    EXPECT_EQ(task.trajectory.front().position_m, way.outside_m);
    EXPECT_LT((task.trajectory.back().position_m - way.outside_m).norm(), 0.05);  // its last sample may be a repeat
    for (const HandSample& sample : task.trajectory) {
      const Eigen::Vector3d& p = sample.position_m;
      const Box& obstacle = way.obstacles[0];
      if (p.x() < obstacle.min.x() || p.x() > obstacle.max.x() || std::abs(p.y()) > 0.1) continue;
      EXPECT_GT(p.z(), 0.449) << "seed " << seed;
      ++over;
    }
  }
  EXPECT_GT(over, 500U);
  way.obstacles = {{{-0.1, -0.1, 0.0}, {0.1, 0.1, 100.0}}};  // no hand reaches this high
  for (const HandSample& sample : synthetic_task(way, 1).trajectory) EXPECT_LT(sample.position_m.z(), 1.4);
}

TEST(SyntheticTask, NoiseIsOnEveryPositionThatIsNoRepeat) {
  const SyntheticTask exact =
      synthetic_task(SyntheticHandPath{{0.0, -1.0, 0.3}, {{0.0, 0.0, 0.1}}, {}}, 3, {.repeat_share = 0.0});
  const SyntheticTask noisy = synthetic_task(SyntheticHandPath{{0.0, -1.0, 0.3}, {{0.0, 0.0, 0.1}}, {}}, 3,
                                             {.repeat_share = 0.0, .noise_m = 0.002});
  EXPECT_EQ(synthetic_task(3).trajectory.back().position_m,
            synthetic_task(3, {.noise_m = 0.0}).trajectory.back().position_m);
  const double noise_m = noise_deviation_m(fresh_samples(noisy.trajectory));
  EXPECT_NEAR(noise_m, 0.002, 0.0005);
  EXPECT_LT(noise_deviation_m(fresh_samples(exact.trajectory)), 0.0005);
}

}  // namespace
}  // namespace saccade
