// SPDX-License-Identifier: Apache-2.0
// Views that show most, soonest, against all sequences of that length.
#include "saccade/views/view_set.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <tuple>

#include "support/parallel_backend.hpp"

namespace saccade {
namespace {

/// A promise of voxels in a row, each worth as much.
Promise promise_of(std::initializer_list<int> voxels, double worth = 1.0) {
  Promise promise;
  for (const int x : voxels) promise.voxels.push_back({{x, 0, 0}, worth});
  return promise;
}

/// By definition.
double naive_worth(std::span<const Promise> promises) {
  std::map<std::tuple<int, int, int>, double> most;
  for (const Promise& promise : promises) {
    std::map<std::tuple<int, int, int>, double> sums;
    for (const PromisedVoxel& part : promise.voxels) sums[{part.voxel.x, part.voxel.y, part.voxel.z}] += part.worth;
    for (const auto& [voxel, worth] : sums) most[voxel] = std::max(most[voxel], worth);
  }
  double sum = 0.0;
  for (const auto& [voxel, worth] : most) sum += worth;
  return sum;
}

/// The area under the curve.
double worth_of(std::span<const Promise> promises, const std::vector<std::size_t>& sequence) {
  std::vector<Promise> chosen;
  double sum = 0.0;
  for (const std::size_t i : sequence) {
    chosen.push_back(promises[i]);
    sum += naive_worth(chosen);
  }
  return sum;
}

TEST(ViewSet, AVoxelCountsOnceWithTheMostThatIsPromisedOfIt) {
  Promise twice = promise_of({1, 1, 2}, 0.5);  // 1: two points of one voxel
  EXPECT_DOUBLE_EQ(worth_together(std::vector{twice}), 1.5);
  EXPECT_DOUBLE_EQ(worth_together(std::vector{twice, promise_of({1}, 0.75), promise_of({3})}), 2.5);
  EXPECT_EQ(worth_together({}), 0.0);
}

TEST(ViewSet, ExchangesTheGreedyViewForTwoThatShowMoreAndAsSoon) {
  // The largest one overlaps both halves: greedy alone takes it, and then what adds most, 2 · 5 + 3.
  std::vector<Promise> promises{promise_of({2, 3, 4, 5, 6}), promise_of({1, 2, 3, 4}), promise_of({5, 6, 7, 8, 9})};
  promises[1].voxels.push_back({{0, 0, 0}, 0.5});
  EXPECT_EQ(best_sequence(promises, 2, Executor{}), (std::vector<std::size_t>{2, 1})) << "2 · 5 + 4.5";
  EXPECT_EQ(best_sequence(promises, 1, Executor{}), std::vector<std::size_t>{0});
  promises[2] = promise_of({6, 7, 8});
  EXPECT_EQ(best_sequence(promises, 2, Executor{}).front(), 0U)
      << "the two others show more in the end, but less at first";
}

TEST(ViewSet, HasFewerViewsWhereNoOtherAddsAnything) {
  const std::vector<Promise> promises{promise_of({1, 2}), promise_of({2}), Promise{}};
  EXPECT_EQ(best_sequence(promises, 3, Executor{}), std::vector<std::size_t>{0});
  EXPECT_TRUE(best_sequence(std::vector<Promise>(4), 2, Executor{}).empty());
  EXPECT_TRUE(best_sequence({}, 2, Executor{}).empty());
}

TEST(ViewSet, ComesNearTheBestOfAllPairsAndIsTheSameForEveryThreadCount) {
  double best_in_all = 0.0;
  double found_in_all = 0.0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random{seed};
    std::vector<Promise> promises(12);
    for (Promise& promise : promises) {
      const int begin = static_cast<int>(random() % 40U);
      const int length = 1 + static_cast<int>(random() % 12U);
      for (int x = begin; x < begin + length; ++x) {
        promise.voxels.push_back({{x, 0, 0}, 0.25 * static_cast<double>(1U + random() % 4U)});
      }
    }
    double best = 0.0;
    for (std::size_t i = 0; i < promises.size(); ++i) {
      for (std::size_t j = 0; j < promises.size(); ++j) best = std::max(best, worth_of(promises, {i, j}));
    }
    const std::vector<std::size_t> set = best_sequence(promises, 2, Executor{});
    const double found = worth_of(promises, set);
    EXPECT_LE(found, best + 1e-9);
    EXPECT_GE(found, 0.75 * best);
    EXPECT_EQ(best_sequence(promises, 2, Executor::with_threads(3, test::kParallelBackend)), set);
    best_in_all += best;
    found_in_all += found;
  }
  EXPECT_GE(found_in_all, 0.98 * best_in_all);
}

}  // namespace
}  // namespace saccade
