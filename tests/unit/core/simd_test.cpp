// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/simd.hpp"

#include <gtest/gtest.h>

namespace saccade {
namespace {

TEST(Simd, EveryTargetCanBeForcedAndRuns) {
  const std::vector<std::string> targets = simd_targets();
  ASSERT_FALSE(targets.empty());
  for (const std::string& target : targets) {
    ASSERT_TRUE(use_simd_target(target).ok());
    EXPECT_EQ(simd_target(), target);
  }
  ASSERT_TRUE(use_simd_target("").ok());
  EXPECT_EQ(simd_target(), targets.front());
}

TEST(Simd, AnUnknownTargetIsAnErrorThatNamesThoseThereAre) {
  const Status status = use_simd_target("MMX");
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, Errc::invalid_argument);
  EXPECT_NE(status.error().message.find(simd_targets().front()), std::string::npos);
  EXPECT_EQ(simd_target(), simd_targets().front());
}

}  // namespace
}  // namespace saccade
