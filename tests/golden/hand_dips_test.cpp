// SPDX-License-Identifier: Apache-2.0
// Both dip detectors on the recorded hands, whole trajectories with a mislabelled place left out
// (docs/design/dip-detector.md has the figures for all conditions and twenty seeds).

#include <gtest/gtest.h>

#include <algorithm>

#include "saccade/attention/detector_evaluation.hpp"
#include "support/bad_samples.hpp"
#include "support/dip_reports.hpp"
#include "support/effort.hpp"
#include "support/hand_detectors.hpp"
#include "support/places.hpp"
#include "support/recorded_hands.hpp"

namespace saccade {
namespace {

/// Without the trajectories that have a mislabelled place; empty where there are none.
std::vector<LabelledTrajectory> sound_hands() {
  std::vector<LabelledTrajectory> hands = test::recorded_hands(test::shared_data()).all();
  std::erase_if(hands, [](const LabelledTrajectory& hand) { return is_mislabelled(hand); });
  return hands;
}

struct HeldFigures {
  const char* name;
  double speed;
  double sigma_m;
  test::BadSamples bad;
  double at_20_cm;  ///< precision and recall are at least this
  double at_5_cm;
};
void PrintTo(const HeldFigures& held, std::ostream* out) { *out << held.name; }

class RecordedHandDips : public testing::TestWithParam<HeldFigures> {};

TEST_P(RecordedHandDips, AreWhereThingsWereMoved) {
  const HeldFigures& held = GetParam();
  const std::vector<LabelledTrajectory> hands = sound_hands();
  if (hands.empty()) GTEST_SKIP() << "no recorded hands in " << test::shared_data();
  ASSERT_EQ(hands.size(), 192U);
  const int seeds = held.sigma_m > 0.0 || held.bad.any() ? test::scaled_cases(4) : 1;
  DetectionCounts wide;
  DetectionCounts near;
  for (int seed = 1; seed <= seeds; ++seed) {
    std::uint64_t index{0};
    const HandActionDetector detector = [&](const HandTrajectory& given) {
      auto actions =
          test::by_dips(test::with_bad_samples(given, held.bad, 1000 * static_cast<std::uint64_t>(seed) + index));
      if (actions) near += score(*actions, hands[index++].labels_m, 0.05).counts;
      return actions;
    };
    const EvaluationConditions conditions{
        .speed = held.speed, .sigma_m = held.sigma_m, .seed = static_cast<std::uint64_t>(seed)};
    const auto evaluation = evaluate_detector(detector, hands, conditions);
    ASSERT_TRUE(evaluation.ok());
    wide += evaluation->counts;
  }
  ASSERT_EQ(wide.labels, 249U * static_cast<std::size_t>(seeds));
  EXPECT_GE(wide.precision(), held.at_20_cm);
  EXPECT_GE(wide.recall(), held.at_20_cm);
  EXPECT_GE(near.precision(), held.at_5_cm);
  EXPECT_GE(near.recall(), held.at_5_cm);
}

INSTANTIATE_TEST_SUITE_P(
    Golden, RecordedHandDips,
    testing::Values(HeldFigures{"clean", 1.0, 0.0, {}, 0.99, 0.96}, HeldFigures{"quarter", 0.25, 0.0, {}, 0.99, 0.96},
                    HeldFigures{"four times", 4.0, 0.0, {}, 0.99, 0.96},
                    HeldFigures{"quarter, 5 cm", 0.25, 0.05, {}, 0.985, 0.80},
                    HeldFigures{"5 cm", 1.0, 0.05, {}, 0.99, 0.88},
                    HeldFigures{"four times, 5 cm", 4.0, 0.05, {}, 0.99, 0.88},
                    HeldFigures{"10 cm", 1.0, 0.10, {}, 0.98, 0.80},
                    HeldFigures{"outliers and repeats", 1.0, 0.0, {0.05, false, 0.5}, 0.98, 0.96},
                    HeldFigures{"farthest outliers and repeats", 1.0, 0.0, {0.05, true, 0.5}, 0.98, 0.96}));

TEST(RecordedHandDipStream, ReportsWithoutNoiseSoonAndNothingWrong) {
  const std::vector<LabelledTrajectory> hands = sound_hands();
  if (hands.empty()) GTEST_SKIP() << "no recorded hands in " << test::shared_data();
  DetectionCounts counts;
  std::vector<double> latencies_s;
  for (const LabelledTrajectory& hand : hands) {
    const std::vector<test::DipReport> reports = test::dip_reports(hand.trajectory);
    counts += score(test::actions_of(reports), hand.labels_m).counts;
    const std::vector<double> of_hand_s = test::latencies_s(reports, hand.trajectory, hand.labels_m);
    latencies_s.insert(latencies_s.end(), of_hand_s.begin(), of_hand_s.end());
  }
  EXPECT_GE(counts.recall(), 0.99);
  EXPECT_GE(counts.precision(), 0.99);
  ASSERT_GT(latencies_s.size(), 240U);
  std::sort(latencies_s.begin(), latencies_s.end());
  EXPECT_LE(latencies_s[latencies_s.size() / 2], 0.2);
}

}  // namespace
}  // namespace saccade
