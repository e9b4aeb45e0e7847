// SPDX-License-Identifier: Apache-2.0
#include "saccade/sensor/hand_tracker.hpp"

#include <gtest/gtest.h>

namespace saccade {
namespace {

TEST(RecordedHand, PlaysItsSamplesAndEnds) {
  RecordedHand hand{{{0.0, {1.0, 0.0, 0.0}, {}}, {0.1, {2.0, 0.0, 0.0}, {}}}};
  EXPECT_EQ(hand.next().value()->position_m.x(), 1.0);
  EXPECT_EQ(hand.next().value()->time_s, 0.1);
  EXPECT_FALSE(hand.next().value());
  EXPECT_FALSE(RecordedHand{}.next().value());
}

}  // namespace
}  // namespace saccade
