// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/phase_times.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace saccade {
namespace {

using std::chrono::milliseconds;

TEST(PhaseTimes, TimeWithinAnotherPhaseCountsOnce) {
  PhaseTimes times;
  const int answer = times.measure(Phase::saliency, [&] {
    std::this_thread::sleep_for(milliseconds{5});
    times.measure(Phase::segmentation, [] { std::this_thread::sleep_for(milliseconds{20}); });
    return 42;
  });
  EXPECT_EQ(answer, 42);
  EXPECT_GE(times.ms(Phase::segmentation), 20.0);
  EXPECT_GE(times.ms(Phase::saliency), 5.0);
  EXPECT_LT(times.ms(Phase::saliency), times.ms(Phase::segmentation));
  EXPECT_EQ(times.ms(Phase::gain), 0.0);
}

TEST(PhaseTimes, AreAddedUp) {
  PhaseTimes a;
  a.add(Phase::gain, 2.0);
  a.add(Phase::gain, 1.0);
  PhaseTimes b;
  b.add(Phase::fusion, 4.0);
  b.add(a);
  EXPECT_EQ(b.ms(Phase::gain), 3.0);
  EXPECT_EQ(b.total_ms(), 7.0);
  EXPECT_FALSE(a == b);
}

TEST(PhaseTimes, TheNamesAreInTheOrderOfThePhases) {
  for (std::size_t i = 0; i < kPhaseNames.values.size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(kPhaseNames.values[i]), i);
  }
  EXPECT_EQ(text_of(Phase::obstacles), "planner's map");
  EXPECT_EQ(text_of(Phase::gain), "evaluation");
}

}  // namespace
}  // namespace saccade
