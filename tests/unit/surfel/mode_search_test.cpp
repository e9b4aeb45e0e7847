// SPDX-License-Identifier: Apache-2.0
// Searches in the colours of modes: equal to plain loops, ties included, on every instruction set.
#include "saccade/surfel/mode_search.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "saccade/core/simd.hpp"

namespace saccade {
namespace {

struct SearchTargetGuard {
  SearchTargetGuard() = default;
  SearchTargetGuard(const SearchTargetGuard&) = delete;
  SearchTargetGuard& operator=(const SearchTargetGuard&) = delete;
  ~SearchTargetGuard() { static_cast<void>(use_simd_target("")); }
};

TEST(ModeSearch, EqualsPlainLoopsOnEveryInstructionSet) {
  const SearchTargetGuard guard;
  std::size_t compared{0};
  std::size_t ties{0};
  const std::vector<std::string> targets = simd_targets();
  for (const std::string& target : targets) {
    ASSERT_TRUE(use_simd_target(target).ok());
    std::mt19937 rng{5};
    // The fewer values a channel has, the more ties.
    for (const int values : {2, 3, 256, 255 * ColorUnits::kPerLevel + 1}) {
      const auto channel = [&] {
        const auto step = 255 * ColorUnits::kPerLevel / (values - 1);
        return static_cast<std::int32_t>(rng() % static_cast<unsigned>(values)) * step;
      };
      for (int i = 0; i < 640; ++i) {
        const std::size_t count = 1 + static_cast<std::size_t>(i) % 32;
        std::array<std::uint64_t, 32 + 7> packed;
        for (std::uint64_t& color : packed) color = ColorUnits{channel(), channel(), channel()}.packed();
        const ColorUnits wanted{channel(), channel(), channel()};
        const auto squared = [&](std::size_t k) { return squared_distance(ColorUnits::unpacked(packed[k]), wanted); };
        std::size_t nearest{0};
        for (std::size_t k = 1; k < count; ++k) {
          if (squared(k) < squared(nearest)) nearest = k;
          if (squared(k) == squared(nearest) && k != nearest) ++ties;
        }
        const std::size_t room = count + rng() % (33 - count);
        std::array<ColorQuery, 2> queries{ColorQuery{packed.data(), count, wanted, {}},
                                          ColorQuery{packed.data(), 1, wanted, {}}};
        find_nearest(queries, room);
        ASSERT_EQ(queries[0].nearest.index, nearest) << target << ", " << count << " colours";
        ASSERT_EQ(queries[0].nearest.squared_units, squared(nearest));
        ASSERT_EQ(queries[1].nearest.index, 0U);
        ASSERT_EQ(queries[1].nearest.squared_units, squared(0));
        const std::int64_t limit = squared(rng() % count);
        std::uint32_t within{0};
        for (std::size_t k = 0; k < count; ++k) within |= squared(k) <= limit ? 1U << k : 0U;
        std::array<NearbyQuery, 1> nearby{NearbyQuery{packed.data(), count, wanted, limit, 0}};
        find_nearby(nearby);
        ASSERT_EQ(nearby[0].nearby, within) << target << ", " << count << " colours";
        ++compared;
      }
    }
  }
  EXPECT_EQ(compared, targets.size() * 4 * 640);
  EXPECT_GT(ties, 1000U);
}

TEST(ModeSearch, PackingLosesNothing) {
  const std::int32_t most = 255 * ColorUnits::kPerLevel;
  for (const ColorUnits& color : {ColorUnits{0, most, 12345}, ColorUnits{most, 0, most - 1}, ColorUnits{1, 2, 3}}) {
    EXPECT_EQ(squared_distance(ColorUnits::unpacked(color.packed()), color), 0);
  }
  EXPECT_EQ(squared_distance(ColorUnits{0, 0, 0}, ColorUnits{most, most, most}),
            3 * static_cast<std::int64_t>(most) * most);
}

TEST(ModeSearch, MeansRoundToTheNearestUnit) {
  const ColorUnits mean = mean_color({0, 100, 255 * ColorUnits::kPerLevel}, {3, 0, 0}, 0.25F);
  EXPECT_EQ(mean.r, 1);
  EXPECT_EQ(mean.g, 75);
  EXPECT_EQ(mean.b, 255 * ColorUnits::kPerLevel * 3 / 4);
}

}  // namespace
}  // namespace saccade
