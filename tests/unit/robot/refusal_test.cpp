// SPDX-License-Identifier: Apache-2.0
#include "saccade/robot/refusal.hpp"

#include <gtest/gtest.h>

namespace saccade {
namespace {

TEST(Refusals, AreCountedAndSaidInWords) {
  RefusalCounts refused;
  EXPECT_EQ(in_words(refused), "");
  refused.add(Refusal::no_path);
  refused.add(Refusal::no_ik, 2);
  EXPECT_EQ(refused.total(), 3U);
  EXPECT_EQ(in_words(refused), "2 out of reach, 1 without a path");
}

}  // namespace
}  // namespace saccade
