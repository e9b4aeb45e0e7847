// SPDX-License-Identifier: Apache-2.0
#include "saccade/sensor/hand_trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace saccade {
namespace {

HandSample sample_at(double time_s, double x_m) { return {time_s, {x_m, 0.0, 0.0}, std::nullopt}; }

/// Ten per second, with one of everything.
HandTrajectory troubled_samples() {
  return {sample_at(0.0, 0.0),      sample_at(0.1, 0.1), sample_at(0.2, std::nan("")), sample_at(0.2, 0.2),
          sample_at(0.2, 0.25),     sample_at(0.1, 0.3), sample_at(0.3, 0.2),          sample_at(0.9, 0.4),
          sample_at(HUGE_VAL, 0.5), sample_at(1.0, 0.6)};
}

TEST(TrajectoryCheck, CountsWhatIsWrong) {
  const SampleReport report = check_samples(troubled_samples());
  EXPECT_EQ(report.samples, 10U);
  EXPECT_EQ(report.not_finite, 2U);
  EXPECT_EQ(report.not_increasing, 2U);
  EXPECT_EQ(report.good(), 6U);
  EXPECT_EQ(report.repeats, 1U);
  EXPECT_EQ(report.gaps, 1U);
  EXPECT_NEAR(report.interval_s, 0.1, 1e-12);
  EXPECT_NEAR(report.longest_interval_s, 0.6, 1e-12);
  EXPECT_EQ(report.to_string(),
            "10 samples, 100 ms apart; 2 not finite, 2 without increasing time, 1 repeat, 1 gap up to 600 ms");
}

TEST(TrajectoryCheck, GoodSamplesAreSaidToBeGood) {
  const HandTrajectory good{sample_at(0.0, 0.0), sample_at(0.0125, 0.1), sample_at(0.025, 0.2)};
  EXPECT_EQ(check_samples(good).to_string(), "3 samples, 12.5 ms apart");
  EXPECT_EQ(check_samples({}).to_string(), "0 samples");
  EXPECT_EQ(check_samples(HandTrajectory{sample_at(0.0, 0.0)}).to_string(), "1 sample");
  EXPECT_EQ(check_samples(HandTrajectory{sample_at(0.0, 0.0), sample_at(1e300, 0.1)}).to_string(),
            "2 samples, 1e+303 ms apart");
  EXPECT_TRUE(validate(good));
  EXPECT_TRUE(validate(HandTrajectory{}));
}

TEST(TrajectoryCheck, UsableSamplesLeaveOutTheBadOnes) {
  const HandTrajectory usable = usable_samples(troubled_samples());
  ASSERT_EQ(usable.size(), 6U);
  EXPECT_EQ(usable[2].position_m.x(), 0.2);
  EXPECT_EQ(usable[3].position_m.x(), 0.2);
  EXPECT_EQ(usable[5].time_s, 1.0);
  EXPECT_EQ(check_samples(usable).bad(), 0U);
  EXPECT_TRUE(validate(usable));
}

TEST(TrajectoryCheck, TheFirstBadSampleIsNamed) {
  const Status status = validate(troubled_samples());
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().context, "sample 2");
  const Status late = validate(HandTrajectory{sample_at(0.0, 0.0), sample_at(0.0, 0.1)});
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().context, "sample 1");
}

}  // namespace
}  // namespace saccade
