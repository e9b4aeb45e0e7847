// SPDX-License-Identifier: Apache-2.0
// Both dip detectors on the recorded hands, whole trajectories with a mislabelled place left out (docs/dip-detector.md
// has the figures for all conditions and twenty seeds).

#include <gtest/gtest.h>

#include <algorithm>

#include "saccade/attention/dip_detector.hpp"
#include "support/effort.hpp"
#include "support/hand_data.hpp"

namespace saccade {
namespace {

std::filesystem::path hands_folder() { return std::filesystem::path{SACCADE_SHARED_DATA} / "hand_polhemus"; }

struct HeldFigures {
  const char* name;
  test::HandCondition condition;
  double at_20_cm;  ///< precision and recall are at least this
  double at_5_cm;
};
void PrintTo(const HeldFigures& held, std::ostream* out) { *out << held.name; }

class RecordedHandDips : public testing::TestWithParam<HeldFigures> {};

TEST_P(RecordedHandDips, AreWhereThingsWereMoved) {
  const HeldFigures& held = GetParam();
  const std::vector<test::RecordedHand> hands = test::recorded_hands(hands_folder());
  if (hands.empty()) GTEST_SKIP() << "no " << hands_folder();
  ASSERT_EQ(hands.size(), 192U);
  const int seeds = test::is_random(held.condition) ? test::scaled_cases(4) : 1;
  test::DetectionScore wide;
  test::DetectionScore near;
  for (int seed = 0; seed < seeds; ++seed) {
    for (std::size_t i = 0; i < hands.size(); ++i) {
      std::mt19937_64 random = test::hand_random(seed, i);
      const auto result = detect_dips(test::disturbed(hands[i].positions_m, held.condition, random));
      ASSERT_TRUE(result.ok());
      wide.add(hands[i].labels_m, result->actions, 0.2);
      near.add(hands[i].labels_m, result->actions, 0.05);
    }
  }
  ASSERT_EQ(wide.labels, 249U * static_cast<std::size_t>(seeds));
  EXPECT_GE(wide.precision(), held.at_20_cm);
  EXPECT_GE(wide.recall(), held.at_20_cm);
  EXPECT_GE(near.precision(), held.at_5_cm);
  EXPECT_GE(near.recall(), held.at_5_cm);
}

INSTANTIATE_TEST_SUITE_P(
    Golden, RecordedHandDips,
    testing::Values(HeldFigures{"clean", {}, 0.99, 0.96}, HeldFigures{"quarter", {.speed = 0.25}, 0.99, 0.96},
                    HeldFigures{"four times", {.speed = 4.0}, 0.99, 0.96},
                    HeldFigures{"quarter, 5 cm", {.speed = 0.25, .noise_m = 0.05}, 0.985, 0.80},
                    HeldFigures{"5 cm", {.noise_m = 0.05}, 0.99, 0.88},
                    HeldFigures{"four times, 5 cm", {.speed = 4.0, .noise_m = 0.05}, 0.99, 0.88},
                    HeldFigures{"10 cm", {.noise_m = 0.10}, 0.98, 0.80},
                    HeldFigures{"outliers and repeats", {.outlier_share = 0.05, .repeat_share = 0.5}, 0.98, 0.96},
                    HeldFigures{"farthest outliers and repeats",
                                {.outlier_share = 0.05, .farthest_outliers = true, .repeat_share = 0.5},
                                0.98,
                                0.96}));

TEST(RecordedHandDipStream, ReportsWithoutNoiseSoonAndNothingWrong) {
  const std::vector<test::RecordedHand> hands = test::recorded_hands(hands_folder());
  if (hands.empty()) GTEST_SKIP() << "no " << hands_folder();
  test::DetectionScore score;
  std::vector<double> latencies_s;
  std::mt19937_64 random{0};
  for (const test::RecordedHand& hand : hands) {
    const HandTrajectory samples = test::disturbed(hand.positions_m, {}, random);
    const test::StreamedActions streamed = test::streamed_actions(samples);
    score.add(hand.labels_m, streamed.actions, 0.2);
    const std::vector<double> of_hand_s = test::latencies_s(streamed, samples, hand.labels_m);
    latencies_s.insert(latencies_s.end(), of_hand_s.begin(), of_hand_s.end());
  }
  EXPECT_GE(score.recall(), 0.99);
  EXPECT_GE(score.precision(), 0.99);
  ASSERT_GT(latencies_s.size(), 240U);
  std::sort(latencies_s.begin(), latencies_s.end());
  EXPECT_LE(latencies_s[latencies_s.size() / 2], 0.2);
}

}  // namespace
}  // namespace saccade
