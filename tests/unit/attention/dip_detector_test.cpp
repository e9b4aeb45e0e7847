// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/dip_detector.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "saccade/attention/internal/speed_dips.hpp"
#include "support/bad_samples.hpp"
#include "support/made_hands.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

const std::vector<Vector3d> kPlaces{
    {0.8, 0.0, 0.3}, {0.3, 0.2, 0.05}, {-0.3, 0.1, 0.1}, {-0.2, -0.6, 0.0}, {0.8, 0.0, 0.4}};

DipResult dips_in(const HandTrajectory& hand) {
  auto result = detect_dips(hand);
  EXPECT_TRUE(result.ok());
  return result.ok() ? *result : DipResult{};
}

/// One action near every place but the first and the last, in their order.
void expect_actions(const DipResult& result, const std::vector<Vector3d>& places_m, double within_m) {
  ASSERT_EQ(result.actions.size() + 2, places_m.size()) << result.why;
  for (std::size_t i = 0; i < result.actions.size(); ++i) {
    EXPECT_LT((result.actions[i].position_m - places_m[i + 1]).norm(), within_m) << i;
  }
}

void expect_nothing(const HandTrajectory& hand) {
  const DipResult result = dips_in(hand);
  EXPECT_TRUE(result.actions.empty()) << result.why;
  EXPECT_FALSE(result.why.empty());
}

TEST(DipDetector, FindsEveryStopAtAnySpeed) {
  for (const double slower : {0.25, 1.0, 4.0, 100.0}) {
    const test::HandPace pace{0.8 * slower, 0.2 * slower, 0.01};
    const DipResult result = dips_in(test::hand_through(kPlaces, pace));
    expect_actions(result, kPlaces, 0.01);
    for (std::size_t i = 0; i < result.actions.size(); ++i) {
      EXPECT_NEAR(result.actions[i].time_s, slower * (0.9 + static_cast<double>(i)), 0.05 * slower);
      EXPECT_GT(result.actions[i].saliency, DipConfig{}.prominence.rise);
      EXPECT_NE(result.actions[i].why.find("m/s"), std::string::npos);
    }
    EXPECT_EQ(result.dips.size(), result.actions.size());
    EXPECT_GT(result.motion.size(), 100U);
    EXPECT_LT(result.noise_m, 0.01);
    EXPECT_GT(result.repeated_samples, 0U);
    EXPECT_EQ(result.outliers, 0U);
  }
}

TEST(DipDetector, SaysHowFastTheHandWasAround) {
  const std::vector<Vector3d> places{{0, 0, 0}, {1, 0, 0}, {1, 0.5, 0}};
  const DipResult result = dips_in(test::hand_through(places));
  ASSERT_EQ(result.dips.size(), 1U);
  // The peak of a motion with the least jerk is 15/8 of its mean speed; smoothing takes some of it away.
  EXPECT_NEAR(result.dips[0].before_mps, 1.875 / 0.8, 0.2);
  EXPECT_NEAR(result.dips[0].after_mps, 1.875 * 0.5 / 0.8, 0.15);
  EXPECT_DOUBLE_EQ(result.dips[0].prominence(), std::log(result.dips[0].after_mps / result.dips[0].speed_mps));
}

TEST(DipDetector, FindsThemUnderFiveCentimetresOfNoise) {
  std::mt19937_64 random{7};
  for (int seed = 0; seed < 20; ++seed) {
    HandTrajectory hand = test::hand_through(kPlaces);
    test::add_noise(hand, 0.05, random);
    const DipResult result = dips_in(hand);
    expect_actions(result, kPlaces, 0.15);
    EXPECT_NEAR(result.noise_m, 0.05, 0.01);
    EXPECT_GT(result.kernel_s, 0.05);
  }
}

TEST(DipDetector, FindsThemAmongOutliersAndRepeats) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const test::BadSamples bad{.outlier_share = 0.05, .repeat_share = 0.5};
    const DipResult result = dips_in(test::with_bad_samples(test::hand_through(kPlaces), bad, seed));
    expect_actions(result, kPlaces, 0.05);
    EXPECT_GT(result.outliers, 2U);
  }
}

TEST(DipDetector, FindsNothingWhereNothingHappens) {
  expect_nothing({});
  expect_nothing({{1.0, {0.1, 0.2, 0.3}, {}}});
  expect_nothing({{1.0, {0.1, 0.2, 0.3}, {}}, {1.1, {0.2, 0.2, 0.3}, {}}});
  HandTrajectory constant;
  HandTrajectory straight;
  HandTrajectory at_once;
  for (int i = 0; i < 200; ++i) {
    constant.push_back({0.01 * i, {0.1, 0.2, 0.3}, {}});
    straight.push_back({0.01 * i, {0.01 * i, 0.02 * i, 0.3}, {}});
    at_once.push_back({5.0, {0.01 * i, 0.0, 0.0}, {}});
  }
  expect_nothing(constant);
  expect_nothing(straight);
  expect_nothing(at_once);
  expect_nothing(test::hand_through(std::vector<Vector3d>{{0, 0, 0}, {1, 0, 0}}));
}

TEST(DipDetector, NoiseOfAHandAtRestIsNoAction) {
  std::mt19937_64 random{9};
  for (const double noise_m : {0.0002, 0.01, 0.1}) {
    for (int seed = 0; seed < 20; ++seed) {
      HandTrajectory hand;
      for (int i = 0; i < 200; ++i) hand.push_back({0.01 * i, {0.1, 0.2, 0.3}, {}});
      test::add_noise(hand, noise_m, random);
      expect_nothing(hand);
    }
  }
}

TEST(DipDetector, NamesTheSampleThatIsNotUsable) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const HandTrajectory good = test::hand_through(kPlaces);
  const auto error_of = [&](const HandSample& bad) {
    HandTrajectory hand = good;
    hand[17] = bad;
    const auto result = detect_dips(hand);
    EXPECT_FALSE(result.ok());
    if (result) return;
    EXPECT_EQ(result.error().code, Errc::invalid_argument);
    EXPECT_EQ(result.error().context, "sample 17");
    EXPECT_EQ(result.error().message.find("huge"), std::string::npos);
  };
  error_of({nan, {0, 0, 0}, {}});
  error_of({infinity, {0, 0, 0}, {}});
  error_of({good[17].time_s, {0, nan, 0}, {}});
  error_of({good[17].time_s, {0, 0, -infinity}, {}});
  error_of({good[17].time_s, {1e300, 0, 0}, {}});
  error_of({good[16].time_s - 0.001, {0, 0, 0}, {}});
}

TEST(DipDetector, RefusesABadConfig) {
  for (double DipConfig::*value :
       {&DipConfig::max_kernel_share, &DipConfig::speed_floor_share, &DipConfig::outlier_limit}) {
    for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
      DipConfig config;
      config.*value = bad;
      EXPECT_FALSE(detect_dips({}, config).ok());
    }
  }
  DipConfig wide;
  wide.max_kernel_share = 1.5;
  EXPECT_FALSE(wide.validate().ok());
  DipConfig shallow;
  shallow.prominence.rise = 0.0;
  EXPECT_FALSE(shallow.validate().ok());
  DipConfig narrow;
  narrow.kernel.length_m = 0.0;
  EXPECT_FALSE(narrow.validate().ok());
}

TEST(DipDetector, TakesRepeatedTimeStamps) {
  HandTrajectory twice;
  for (const HandSample& sample : test::hand_through(kPlaces)) {
    twice.push_back({sample.time_s, sample.position_m + Vector3d{0.01, 0.0, 0.0}, {}});
    twice.push_back({sample.time_s, sample.position_m - Vector3d{0.01, 0.0, 0.0}, {}});
  }
  expect_actions(dips_in(twice), kPlaces, 0.01);
}

TEST(DipDetector, ALongRestIsOneAction) {
  HandTrajectory hand = test::hand_through(kPlaces);
  for (HandSample& sample : hand) {
    if (sample.time_s > 1.9) sample.time_s += 60.0;
  }
  const DipResult result = dips_in(hand);
  expect_actions(result, kPlaces, 0.02);
  EXPECT_NEAR(result.actions[1].time_s, 31.9, 5.0);
}

TEST(DipDetector, FindsAThousandStopsInAHundredThousandSamples) {
  std::mt19937_64 random{10};
  const std::vector<Vector3d> places = test::places_on_table(1002, random);
  const HandTrajectory hand = test::hand_through(places);
  ASSERT_GT(hand.size(), 100000U);
  expect_actions(dips_in(hand), places, 0.02);
}

TEST(HandSmoothing, BinsAreAsGoodAsAllSamples) {
  std::mt19937_64 random{11};
  HandTrajectory hand = test::hand_through(kPlaces);
  test::add_noise(hand, 0.01, random);
  const std::vector<TimedPoint> samples = fresh_samples(hand);
  const double kernel_s{0.07};
  const std::vector<SmoothedPoint> motion = smooth(samples, kernel_s, 0.0);
  ASSERT_GT(motion.size(), 200U);
  for (const SmoothedPoint& point : motion) {
    const SmoothedPoint direct = test::smoothed_at(samples, point.time_s, kernel_s, 0.0);
    EXPECT_NEAR((point.position_m - direct.position_m).norm(), 0.0, 0.003);
    EXPECT_NEAR(point.speed_mps, direct.speed_mps, 0.05);
  }
}

TEST(HandSmoothing, SpeedIsFreeOfWhatNoiseAddsToIt) {
  std::mt19937_64 random{12};
  double sum_squared{0.0};
  std::size_t count{0};
  for (int seed = 0; seed < 30; ++seed) {
    HandTrajectory hand;
    for (int i = 0; i < 400; ++i) hand.push_back({0.01 * i, {0.003 * i, 0.0, 0.0}, {}});
    test::add_noise(hand, 0.02, random);
    for (const SmoothedPoint& point : smooth(fresh_samples(hand), 0.1, 0.02)) {
      sum_squared += point.speed_mps * point.speed_mps;
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(sum_squared / static_cast<double>(count)), 0.3, 0.01);
}

TEST(HandSmoothing, ThirdDifferencesSeeNoQuadraticMotionAndAllOfTheNoise) {
  std::mt19937_64 random{13};
  std::uniform_real_distribution<double> interval_s{0.005, 0.02};
  HandTrajectory hand;
  double time_s{0.0};
  for (int i = 0; i < 2000; ++i) {
    hand.push_back({time_s, {time_s * time_s, 1.0 - 2.0 * time_s, 0.5 * time_s * time_s}, {}});
    time_s += interval_s(random);
  }
  EXPECT_LT(noise_deviation_m(fresh_samples(hand)), 1e-9);
  test::add_noise(hand, 0.02, random);
  EXPECT_NEAR(noise_deviation_m(fresh_samples(hand)), 0.02, 0.001);
}

TEST(HandSmoothing, KernelIsAsWideAsNoiseAndSpeedAskFor) {
  const KernelConfig config{0.1, 0.06};
  EXPECT_DOUBLE_EQ(kernel_width_s(config, 2.0, 0.0, 0.01), 0.05);
  const double h = kernel_width_s({1e-9, 0.06}, 2.0, 0.05, 0.01);
  EXPECT_NEAR(0.05 * std::sqrt(0.01 / (4.0 * std::sqrt(M_PI) * h * h * h)), 0.06 * 2.0, 1e-9);
}

TEST(HandSmoothing, AGrossOutlierGoesAndNothingElse) {
  HandTrajectory hand = test::hand_through(kPlaces);
  std::vector<TimedPoint> samples = fresh_samples(hand);
  EXPECT_EQ(without_outliers(samples, 0.0, 2.7).size(), samples.size());
  samples[30].position_m.x() += 0.5;
  samples[32].position_m.z() -= 0.4;
  const std::vector<TimedPoint> kept = without_outliers(samples, 0.0, 2.7);
  ASSERT_EQ(kept.size() + 2, samples.size());
  EXPECT_DOUBLE_EQ(kept[30].time_s, samples[31].time_s);
  EXPECT_DOUBLE_EQ(kept[31].time_s, samples[33].time_s);
}

TEST(SpeedDips, ADipNeedsADropAndARise) {
  const auto dips_of = [](const std::vector<double>& speeds) {
    SpeedDips finder{{std::log(2.0), std::log(2.0)}};
    std::vector<Dip> dips;
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      const auto time_s = static_cast<double>(i);
      if (const auto dip = finder.put({time_s, {time_s, 0, 0}, speeds[i]}, 0.01)) dips.push_back(*dip);
    }
    return dips;
  };
  EXPECT_TRUE(dips_of({}).empty());
  EXPECT_TRUE(dips_of({1.0, 0.1, 0.1, 0.1}).empty());
  EXPECT_TRUE(dips_of({0.1, 1.0}).empty());
  EXPECT_TRUE(dips_of({1.0, 0.6, 1.0, 0.6, 1.0}).empty());
  const std::vector<Dip> one = dips_of({0.5, 1.0, 0.0, 0.0, 0.0, 0.015, 0.3, 0.25, 0.4});
  ASSERT_EQ(one.size(), 1U);
  EXPECT_DOUBLE_EQ(one[0].at.time_s, 3.0);
  EXPECT_DOUBLE_EQ(one[0].at.position_m.x(), 3.0);
  EXPECT_DOUBLE_EQ(one[0].speed_mps, 0.01);
  EXPECT_DOUBLE_EQ(one[0].before_mps, 1.0);
  EXPECT_EQ(dips_of({1.0, 0.1, 1.0, 0.1, 1.0}).size(), 2U);
}

}  // namespace
}  // namespace saccade
