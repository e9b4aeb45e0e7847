// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/voxel_index.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace saccade {
namespace {

constexpr IndexBox kBox{{-2, 0, 5}, {1, 4, 7}};
constexpr IndexBox kEmpty{{3, 3, 3}, {3, 9, 9}};

static_assert(kBox.size() == Index3{3, 4, 2} && kBox.count() == 24.0);
static_assert(IndexBox::cube({1, 2, 3}, 8) == IndexBox{{1, 2, 3}, {9, 10, 11}});
static_assert(kBox.grown(1) == IndexBox{{-3, -1, 4}, {2, 5, 8}});
static_assert(kBox.hull(kEmpty) == kBox && kEmpty.hull(kBox) == kBox && IndexBox{}.hull(kEmpty).empty());
static_assert(kBox.contains(kBox) && kBox.contains(kEmpty) && !kBox.contains(kBox.grown(1)));
static_assert(kBox.overlaps(IndexBox::cube({0, 3, 6}, 1)) && !kBox.overlaps(IndexBox::cube({1, 3, 6}, 9)));
static_assert(!kBox.overlaps(kEmpty));

TEST(IndexBox, VisitsZSlowestXFastest) {
  std::vector<Index3> visited;
  kBox.for_each([&](const Index3& i) { visited.push_back(i); });
  ASSERT_EQ(visited.size(), 24U);
  for (std::size_t i = 0; i < visited.size(); ++i) {
    EXPECT_TRUE(kBox.contains(visited[i]));
    EXPECT_TRUE(i == 0 || zyx_less(visited[i - 1], visited[i]));
  }
  kEmpty.for_each([](const Index3&) { FAIL() << "an empty box holds no index"; });
}

TEST(IndexBox, LayersMakeTheBox) {
  std::vector<Index3> visited;
  std::vector<Index3> by_layer;
  kBox.for_each([&](const Index3& i) { visited.push_back(i); });
  for (std::size_t layer = 0; layer < 2; ++layer) {
    kBox.layer(layer).for_each([&](const Index3& i) { by_layer.push_back(i); });
  }
  EXPECT_EQ(by_layer, visited);
}

// Against the definitions, index by index.
TEST(IndexBox, SetsOfIndices) {
  std::mt19937 random{1};
  const auto index = [&] {
    const auto coordinate = [&] { return static_cast<std::int32_t>(random() % 5U) - 2; };
    return Index3{coordinate(), coordinate(), coordinate()};
  };
  const auto box = [&] {
    const auto edge = [&] { return static_cast<std::int32_t>(random() % 5U); };
    const Index3 lo = index();
    return IndexBox{lo, lo + Index3{edge(), edge(), edge()}};
  };
  int overlapping = 0;
  int contained = 0;
  for (int i = 0; i < 2000; ++i) {
    const IndexBox a = box();
    const IndexBox b = box();
    int both = 0;
    int only_b = 0;
    IndexBox::cube({-3, -3, -3}, 10).for_each([&](const Index3& p) {
      const bool in_both = a.contains(p) && b.contains(p);
      EXPECT_EQ(a.intersection(b).contains(p), in_both);
      EXPECT_TRUE(a.hull(b).contains(p) || !(a.contains(p) || b.contains(p)));
      both += in_both ? 1 : 0;
      only_b += !a.contains(p) && b.contains(p) ? 1 : 0;
    });
    EXPECT_EQ(a.overlaps(b), both > 0);
    EXPECT_EQ(a.contains(b), only_b == 0);
    overlapping += both > 0 ? 1 : 0;
    contained += both > 0 && only_b == 0 ? 1 : 0;
  }
  EXPECT_GT(overlapping, 20);
  EXPECT_GT(contained, 0);
}

TEST(IndexBox, ParentsHoldEveryIndex) {
  constexpr IndexBox kVoxels{{-9, 0, 7}, {1, 8, 9}};
  EXPECT_EQ(parents(kVoxels), (IndexBox{{-2, 0, 0}, {1, 1, 2}}));
  IndexBox hull;
  kVoxels.for_each([&](const Index3& voxel) { hull = hull.hull(IndexBox::cube(parent(voxel), 1)); });
  EXPECT_EQ(hull, parents(kVoxels));
}

}  // namespace
}  // namespace saccade
