// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/names.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "saccade/core/phase_times.hpp"
#include "saccade/core/result.hpp"

namespace saccade {
namespace {

enum class Side { left, right, middle };

constexpr auto kSideNames =
    make_names<Side>({{Side::left, "left"}, {Side::right, "right"}, {Side::middle, "middle"}, {Side::left, "l"}});
static_assert(kSideNames.of(Side::left) == "left");
static_assert(kSideNames.find("middle") == Side::middle);
// Checks by which make_names finds enumerators without a word.
static_assert(is_enumerator<Side::left>() && is_enumerator<static_cast<Side>(2)>());
static_assert(!is_enumerator<static_cast<Side>(3)>() && !is_enumerator<static_cast<Side>(-1)>());
static_assert(has_every(kSideNames, std::make_index_sequence<5>{}));
static_assert(!has_every(make_some_names<Side>({{Side::left, "left"}, {Side::middle, "middle"}}),
                         std::make_index_sequence<3>{}));

TEST(Names, GoToAWordAndBack) {
  for (const Side side : {Side::left, Side::right, Side::middle}) {
    EXPECT_EQ(kSideNames.find(kSideNames.of(side)), side);
  }
  EXPECT_EQ(kSideNames.find("l"), Side::left);
  EXPECT_EQ(kSideNames.of(Side::left), "left");
}

TEST(Names, DoNotKnowEveryWord) {
  for (const std::string_view word : {"", "Left", "left ", "lef", "unknown"}) EXPECT_FALSE(kSideNames.find(word));
  EXPECT_EQ(kSideNames.of(static_cast<Side>(7)), "unknown");
}

TEST(Names, AreListed) {
  EXPECT_EQ(kSideNames.listed(), "left, right, middle or l");
  EXPECT_EQ((make_some_names<Side>({{Side::left, "left"}, {Side::right, "right"}}).listed()), "left or right");
  EXPECT_EQ((make_some_names<Side>({{Side::left, "left"}}).listed()), "left");
  EXPECT_EQ(listed({}), "");
}

TEST(Names, AreJoined) {
  EXPECT_EQ(joined(kSideNames.words, "|"), "left|right|middle|l");
  EXPECT_EQ(joined(std::array{1, 2, 3}, "; ", [](int i) { return std::to_string(i); }), "1; 2; 3");
  EXPECT_EQ(joined(std::vector<std::string>{}), "");
}

TEST(Names, OfErrorsAndPhasesGoBothWays) {
  for (const Errc code : kErrcNames.values) EXPECT_EQ(kErrcNames.find(to_string(code)), code);
  for (const Phase phase : kPhaseNames.values) EXPECT_EQ(kPhaseNames.find(to_string(phase)), phase);
}

}  // namespace
}  // namespace saccade
