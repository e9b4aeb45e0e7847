// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/angle.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace saccade {
namespace {

constexpr double kPi{std::numbers::pi};

// The defaults that were written in radians before, to the bit.
static_assert(5_deg == 0.087266462599716474 && 10_deg == 0.17453292519943295);
static_assert(15_deg == 0.26179938779914943 && 30_deg == 0.52359877559829887);
static_assert(45_deg == 0.78539816339744831 && 90_deg == 1.5707963267948966);
static_assert(30_deg == kPi / 6.0 && 60_deg == 60.0 * (kPi / 180.0) && 100_deg == 100.0 / 180.0 * kPi);
static_assert(180_deg == kPi && 360_deg == 2.0 * kPi && 1_deg == kPi / 180.0);

TEST(Angle, LiteralsWithAndWithoutAPoint) {
  EXPECT_EQ(5_deg, 5.0_deg);
  EXPECT_EQ(-(90_deg), -0.5 * kPi);
  EXPECT_DOUBLE_EQ(2.5_deg, kPi / 72.0);
}

TEST(Angle, ThereAndBack) {
  for (int angle_deg = -360; angle_deg <= 360; ++angle_deg) EXPECT_NEAR(to_deg(to_rad(angle_deg)), angle_deg, 1e-12);
  EXPECT_EQ(to_deg(kPi), 180.0);
  EXPECT_EQ(to_rad(180.0), kPi);
}

}  // namespace
}  // namespace saccade
