// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/dip_detector.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "saccade/attention/detector_evaluation.hpp"
#include "support/bad_samples.hpp"
#include "support/dip_reports.hpp"
#include "support/made_hands.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

const std::vector<Vector3d> kStreamPlaces{
    {0.8, 0.0, 0.3}, {0.3, 0.2, 0.05}, {-0.3, 0.1, 0.1}, {-0.2, -0.6, 0.0}, {0.8, 0.0, 0.4}};

using Report = test::DipReport;

void expect_reports(const std::vector<Report>& reports, const std::vector<Vector3d>& places_m, double within_m) {
  ASSERT_EQ(reports.size() + 2, places_m.size());
  for (std::size_t i = 0; i < reports.size(); ++i) {
    EXPECT_LT((reports[i].action.position_m - places_m[i + 1]).norm(), within_m) << i;
  }
}

TEST(DipStream, ReportsEveryStopBeforeTheNext) {
  for (const double slower : {0.25, 1.0, 4.0, 100.0}) {
    const std::vector<Report> reports = test::dip_reports(
        test::hand_through(kStreamPlaces, {0.8 * slower, 0.2 * slower, 0.01 * std::max(1.0, slower / 8.0)}));
    expect_reports(reports, kStreamPlaces, 0.02);
    for (std::size_t i = 0; i < reports.size(); ++i) {
      const double left_s = slower * (1.0 + static_cast<double>(i));  // when the hand leaves the place
      EXPECT_LT(reports[i].at_s, left_s + 0.4 * slower);
      EXPECT_LT(reports[i].action.time_s, left_s + 0.05 * slower);
      EXPECT_GE(reports[i].action.saliency, DipStreamConfig{}.prominence.rise);
      EXPECT_FALSE(reports[i].action.why.empty());
    }
  }
}

TEST(DipStream, ReportsThemUnderNoiseAndNothingElsewhere) {
  std::mt19937_64 random{17};
  const std::vector<Vector3d> inner(kStreamPlaces.begin() + 1, kStreamPlaces.end() - 1);
  DetectionCounts counts;
  std::size_t reports{0};
  for (int seed = 0; seed < 20; ++seed) {
    HandTrajectory hand = test::hand_through(kStreamPlaces);
    test::add_noise(hand, 0.02, random);
    const std::vector<HandAction> actions = test::actions_of(test::dip_reports(hand));
    counts += score(actions, inner, 0.1).counts;
    reports += actions.size();
  }
  EXPECT_EQ(counts.false_negatives(), 0U);
  EXPECT_EQ(counts.false_positives, 0U);
  EXPECT_LT(reports, 80U);  // 60 places; now and then one comes twice
}

TEST(DipStream, ReportsThemAmongOutliersAndRepeats) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const test::BadSamples bad{.outlier_share = 0.05, .repeat_share = 0.5};
    const HandTrajectory hand = test::with_bad_samples(test::hand_through(kStreamPlaces), bad, seed);
    expect_reports(test::dip_reports(hand), kStreamPlaces, 0.05);
  }
}

TEST(DipStream, WhatItReportsDependsOnNoSampleThatComesLater) {
  const HandTrajectory hand = test::hand_through(kStreamPlaces);
  const std::vector<Report> all = test::dip_reports(hand);
  ASSERT_EQ(all.size(), 3U);
  const auto last =
      std::find_if(hand.begin(), hand.end(), [&](const HandSample& s) { return s.time_s == all[1].at_s; });
  const std::vector<Report> begun = test::dip_reports({hand.begin(), last + 1});
  ASSERT_EQ(begun.size(), 2U);
  EXPECT_EQ(begun[1].action.position_m, all[1].action.position_m);
  EXPECT_EQ(begun[1].action.saliency, all[1].action.saliency);
}

TEST(DipStream, ReportsNothingWhereNothingHappens) {
  HandTrajectory constant;
  HandTrajectory straight;
  for (int i = 0; i < 1000; ++i) {
    constant.push_back({0.01 * i, {0.1, 0.2, 0.3}, {}});
    straight.push_back({0.01 * i, {0.01 * i, 0.02 * i, 0.3}, {}});
  }
  EXPECT_TRUE(test::dip_reports(constant).empty());
  EXPECT_TRUE(test::dip_reports(straight).empty());
  EXPECT_TRUE(test::dip_reports(test::hand_through(std::vector<Vector3d>{{0, 0, 0}, {1, 0, 0}})).empty());
  std::mt19937_64 random{19};
  for (const double noise_m : {0.0002, 0.01, 0.1}) {
    for (int seed = 0; seed < 20; ++seed) {
      HandTrajectory noisy = constant;
      test::add_noise(noisy, noise_m, random);
      EXPECT_TRUE(test::dip_reports(noisy).empty()) << noise_m;
    }
  }
}

TEST(DipStream, LeavesOutABadSampleAndGoesOn) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const HandTrajectory hand = test::hand_through(kStreamPlaces);
  DipStream stream = DipStream::create().value();
  std::vector<Report> reports;
  for (const HandSample& sample : hand) {
    const auto actions = stream.put(sample);
    ASSERT_TRUE(actions.ok());
    for (const HandAction& action : *actions) reports.push_back({action, sample.time_s});
    EXPECT_EQ(stream.put({sample.time_s, {0, nan, 0}, {}}).error().code, Errc::invalid_argument);
    EXPECT_FALSE(stream.put({nan, {0, 0, 0}, {}}).ok());
    EXPECT_FALSE(stream.put({sample.time_s - 0.5, {0, 0, 0}, {}}).ok());
    EXPECT_TRUE(stream.put(sample).ok());  // the same time again
    EXPECT_TRUE(stream.put({sample.time_s, {0, 0, 0}, {}}).ok());
  }
  const std::vector<Report> undisturbed = test::dip_reports(hand);
  ASSERT_EQ(reports.size(), undisturbed.size());
  for (std::size_t i = 0; i < reports.size(); ++i) {
    EXPECT_EQ(reports[i].action.position_m, undisturbed[i].action.position_m);
  }
}

TEST(DipStream, ALongRestIsOneActionAndSoIsALongGap) {
  HandTrajectory rest = test::hand_through(kStreamPlaces);
  HandTrajectory with_repeats;
  for (const HandSample& sample : rest) {
    with_repeats.push_back(sample);
    if (sample.time_s > 1.9) with_repeats.back().time_s += 60.0;
    if (sample.time_s > 1.89 && sample.time_s <= 1.9) {
      for (double late_s = 0.01; late_s < 60.0; late_s += 0.01) {
        with_repeats.push_back({sample.time_s + late_s, sample.position_m, {}});
      }
    }
  }
  expect_reports(test::dip_reports(with_repeats), kStreamPlaces, 0.03);
  for (HandSample& sample : rest) {
    if (sample.time_s > 1.9) sample.time_s += 60.0;
  }
  expect_reports(test::dip_reports(rest), kStreamPlaces, 0.03);
}

TEST(DipStream, GoesOnForAHundredThousandSamples) {
  std::mt19937_64 random{20};
  const std::vector<Vector3d> places = test::places_on_table(1002, random);
  const HandTrajectory hand = test::hand_through(places);
  ASSERT_GT(hand.size(), 100000U);
  expect_reports(test::dip_reports(hand), places, 0.05);
}

TEST(DipStream, RefusesABadConfig) {
  DipStreamConfig config;
  config.delay = -1.0;
  EXPECT_FALSE(DipStream::create(config).ok());
  config = {};
  config.outlier_limit = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(DipStream::create(config).ok());
}

}  // namespace
}  // namespace saccade
