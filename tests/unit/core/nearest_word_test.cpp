// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/nearest_word.hpp"

#include <gtest/gtest.h>

#include <array>

namespace saccade {
namespace {

constexpr std::array<std::string_view, 5> kKnown{"explore", "export", "info", "scene", "max-views"};

TEST(NearestWord, FindsWhatATypingErrorStandsFor) {
  EXPECT_EQ(nearest_word("explor", kKnown), "explore");
  EXPECT_EQ(nearest_word("epxlore", kKnown), "explore");  // swapped letters are one error
  EXPECT_EQ(nearest_word("inof", kKnown), "info");
  EXPECT_EQ(nearest_word("max-view", kKnown), "max-views");
  EXPECT_EQ(nearest_word("scene", kKnown), "scene");
}

TEST(NearestWord, SaysNothingOfWordsThatAreFarAway) {
  EXPECT_EQ(nearest_word("dance", kKnown), "");
  EXPECT_EQ(nearest_word("", kKnown), "");
  EXPECT_EQ(nearest_word("x", kKnown), "");
  EXPECT_EQ(nearest_word(std::string(1000, 'a'), kKnown), "");
  EXPECT_EQ(nearest_word("explore", {}), "");
}

TEST(NearestWord, MakesASuggestion) {
  EXPECT_EQ(did_you_mean("explor", kKnown), "; did you mean explore?");
  EXPECT_EQ(did_you_mean("zzzzzz", kKnown), "");
}

}  // namespace
}  // namespace saccade
