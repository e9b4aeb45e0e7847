// SPDX-License-Identifier: Apache-2.0
// The oracle that looks two views ahead: the pair against all pairs, and its candidates against those of the oracle.
#include "saccade/trial/internal/pair_oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "unit/explore/scanned_clutter.hpp"

namespace saccade {
namespace {

std::size_t shown_by_both(const ShownPoints& a, const ShownPoints& b) {
  std::size_t count{0};
  for (std::size_t i = 0; i < a.size(); ++i) count += static_cast<std::size_t>(std::popcount(a[i] | b[i]));
  return count;
}

TEST(BestPair, ShowsMostOfAllPairs) {
  std::mt19937_64 random{7};
  std::size_t other_than_greedy{0};
  for (int round = 0; round < 20; ++round) {
    std::vector<ShownPoints> shown(400);
    for (std::size_t i = 0; i < shown.size(); ++i) {
      shown[i] = {random() & random(), random() & random() & random(), i % 3 == 0 ? random() : 0};
    }
    std::size_t most{0};
    std::size_t greatest{0};
    for (std::size_t i = 0; i < shown.size(); ++i) {
      if (shown_by_both(shown[i], shown[i]) > shown_by_both(shown[greatest], shown[greatest])) greatest = i;
      for (std::size_t j = 0; j < i; ++j) most = std::max(most, shown_by_both(shown[i], shown[j]));
    }
    const ViewPair pair = best_pair(shown, Executor{}).value();
    EXPECT_EQ(pair.shown, most);
    EXPECT_EQ(shown_by_both(shown[pair.first], shown[pair.second]), most);
    EXPECT_GE(shown_by_both(shown[pair.first], shown[pair.first]),
              shown_by_both(shown[pair.second], shown[pair.second]));
    other_than_greedy += pair.first != greatest ? 1U : 0U;
    const ViewPair again = best_pair(shown, Executor::with_threads(3)).value();
    EXPECT_EQ(again.first, pair.first);
    EXPECT_EQ(again.second, pair.second);
  }
  EXPECT_GT(other_than_greedy, 0U);
}

TEST(BestPair, NeedsTwoViews) {
  EXPECT_FALSE(best_pair({}, Executor{}));
  EXPECT_FALSE(best_pair(std::vector<ShownPoints>{{1}}, Executor{}));
  const ViewPair alike = best_pair(std::vector<ShownPoints>{{1}, {3}, {2}}, Executor{}).value();
  EXPECT_EQ(alike.first, 1U);
  EXPECT_NE(alike.second, 1U);
  EXPECT_EQ(alike.shown, 2U);
}

using PairOracleTest = test::ScannedClutter;

TEST_F(PairOracleTest, BeginsWithTheBestPairOfMoreViewsThanTheOracleHas) {
  SimulatedRunConfig coarse = config();
  coarse.sphere.longitude_step_rad = 60_deg;
  coarse.sphere.latitude_step_rad = 30_deg;
  coarse.sphere.roll_step_rad = 90_deg;
  const Ranking one = ranked(planner("oracle", coarse), scene(scanned()));
  const Ranking two = ranked(planner("oracle-2", coarse), scene(scanned()));
  EXPECT_GT(two.candidates(), one.candidates());
  const std::vector<RankedView> views = two.choice()->candidates;
  ASSERT_GT(views.size(), 40U);
  EXPECT_GE(views[0].gain, views[1].gain);
  EXPECT_TRUE(test::falls(std::span{views}.subspan(2)));
  const double most = std::max(views[0].gain, views[2].gain);
  EXPECT_GE(most, one.best().gain);  // contour views are among the candidates
  // A run's last view is chosen alone.
  SimulatedRunConfig last = coarse;
  last.exploration.max_views = 1;
  EXPECT_EQ(ranked(planner("oracle-2", last), scene(scanned())).best().gain, most);
}

}  // namespace
}  // namespace saccade
