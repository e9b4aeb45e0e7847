// SPDX-License-Identifier: Apache-2.0
// The dips of random hands do not depend on where the world frame stands, nor on when the clock began.

#include <gtest/gtest.h>

#include <numbers>

#include "saccade/attention/detector_evaluation.hpp"
#include "saccade/attention/dip_detector.hpp"
#include "support/bad_samples.hpp"
#include "support/effort.hpp"
#include "support/made_hands.hpp"

namespace saccade {
namespace {

constexpr std::uint64_t kHandSeed{61};

/// Never quite without noise: rounding decides which of evenly spaced samples is the medoid.
HandTrajectory random_hand(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit{0.0, 1.0};
  const test::HandPace pace{0.4 + unit(random), 0.3 * unit(random), 0.01};
  const HandTrajectory hand = test::hand_through(test::places_on_table(3 + random() % 4, random), pace);
  const double noise_m = 1e-4 + (random() % 2 == 0 ? 0.0 : 0.05 * unit(random));
  const test::BadSamples bad{.outlier_share = random() % 2 == 0 ? 0.0 : 0.05,
                             .repeat_share = random() % 2 == 0 ? 0.0 : 0.5};
  const HandTrajectory at_pace = at_speed(hand, std::exp2(4.0 * unit(random) - 2.0)).value();
  const HandTrajectory noisy = with_noise(at_pace, noise_m, random()).value();
  return test::with_bad_samples(noisy, bad, random());
}

Eigen::Isometry3d random_motion(std::mt19937_64& random) {
  std::normal_distribution<double> gaussian{0.0, 1.0};
  Eigen::Isometry3d motion{
      Eigen::Quaterniond{gaussian(random), gaussian(random), gaussian(random), gaussian(random)}.normalized()};
  motion.translation() = 3.0 * Eigen::Vector3d{gaussian(random), gaussian(random), gaussian(random)};
  return motion;
}

TEST(HandDips, MoveWithTheWorldAndTheClock) {
  const int cases = test::scaled_cases(300);
  std::printf("seed %llu, %d cases\n", static_cast<unsigned long long>(kHandSeed), cases);
  std::mt19937_64 random{kHandSeed};
  std::size_t compared{0};
  for (int i = 0; i < cases; ++i) {
    const HandTrajectory hand = random_hand(random);
    const Eigen::Isometry3d T_there_here = random_motion(random);
    const double later_s = std::uniform_real_distribution<double>{-1000.0, 1000.0}(random);
    HandTrajectory moved = hand;
    for (std::size_t k = 0; k < moved.size(); ++k) {
      moved[k].time_s += later_s;
      const bool repeat = k > 0 && hand[k].position_m == hand[k - 1].position_m;
      moved[k].position_m = repeat ? moved[k - 1].position_m : T_there_here * hand[k].position_m;
    }
    const auto here = detect_dips(hand);
    const auto there = detect_dips(moved);
    ASSERT_TRUE(here.ok() && there.ok());
    ASSERT_EQ(here->actions.size(), there->actions.size()) << "case " << i;
    EXPECT_NEAR(here->noise_m, there->noise_m, 1e-6);
    EXPECT_NEAR(here->kernel_s, there->kernel_s, 1e-3 * here->kernel_s);
    EXPECT_EQ(here->outliers, there->outliers);
    for (std::size_t k = 0; k < here->actions.size(); ++k) {
      EXPECT_NEAR((T_there_here * here->actions[k].position_m - there->actions[k].position_m).norm(), 0.0, 1e-3);
      EXPECT_NEAR(here->actions[k].time_s + later_s, there->actions[k].time_s, 0.1 * here->kernel_s);
      EXPECT_NEAR(here->actions[k].saliency, there->actions[k].saliency, 0.02);
      ++compared;
    }
  }
  EXPECT_GT(compared, static_cast<std::size_t>(cases));
}

}  // namespace
}  // namespace saccade
