// SPDX-License-Identifier: Apache-2.0
#include "saccade/sensor/gap_filling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace saccade {
namespace {

DepthImage row(std::vector<float> depths) {
  const int width = static_cast<int>(depths.size());
  return {width, 1, std::move(depths)};
}

TEST(FillGaps, ClosesGapsUpToTheWidthAndNotBeyond) {
  const DepthImage depth = row({1.0F, 0.0F, 1.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F});
  EXPECT_EQ(fill_gaps(depth, {0}).pixels(), depth.pixels());
  EXPECT_EQ(fill_gaps(depth, {1}).pixels(), row({1, 1, 1, 0, 0, 1, 0, 0, 0, 1, 0}).pixels());
  EXPECT_EQ(fill_gaps(depth, {2}).pixels(), row({1, 1, 1, 1, 1, 1, 0, 0, 0, 1, 0}).pixels());
  EXPECT_EQ(fill_gaps(depth, {3}).pixels(), row({1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0}).pixels());
}

TEST(FillGaps, LeavesEdgesOpenAndFreeClaimsAlone) {
  constexpr float kNaN{std::numeric_limits<float>::quiet_NaN()};
  const DepthImage edge = fill_gaps(row({1.0F, 0.0F, 1.05F}), {1});
  EXPECT_EQ(edge(1, 0), 0.0F);
  const DepthImage free = fill_gaps(row({1.0F, -3.0F, 0.0F, 1.0F}), {3});
  EXPECT_EQ(free(1, 0), -3.0F);
  EXPECT_EQ(free(2, 0), 0.0F);
  EXPECT_EQ(fill_gaps(row({1.0F, kNaN, 1.0F}), {1})(1, 0), 1.0F);
}

TEST(FillGaps, IsExactOnATiltedPlane) {
  // n·p = d seen along the rays ((u − 20)/50, (v − 15)/50, 1): 1/z is linear in u and v.
  DepthImage plane{40, 30};
  DepthImage sparse{40, 30};
  for (int v = 0; v < 30; ++v) {
    for (int u = 0; u < 40; ++u) {
      plane(u, v) = static_cast<float>(1.0 / (0.9 + 0.002 * u - 0.003 * v));
      if (u % 3 == 0 && v % 2 == 0) sparse(u, v) = plane(u, v);
    }
  }
  const DepthImage filled = fill_gaps(sparse, {2});
  int compared = 0;
  for (int v = 0; v < 30; v += 2) {
    for (int u = 0; u < 40; ++u) {
      EXPECT_NEAR(filled(u, v), plane(u, v), 1e-6);
      ++compared;
    }
  }
  EXPECT_EQ(compared, 600);
}

TEST(FillGaps, IsChosenForNetsOfReturnsAlone) {
  DepthImage whole{60, 40, 1.0F};
  for (int u = 0; u < 20; ++u) whole(u, 5) = whole(3 * u, 9) = 0.0F;  // a drop-out and some single pixels
  EXPECT_EQ(choose_gap_filling(whole).max_gap_px, 0);
  DepthImage net{60, 40};
  for (int v = 0; v < 40; v += 2) {
    for (int u = 0; u < 60; u += 2) net(u, v) = 1.0F;
  }
  EXPECT_EQ(choose_gap_filling(net).max_gap_px, 2);
  EXPECT_EQ(choose_gap_filling(DepthImage{60, 40}).max_gap_px, 0);
}

TEST(FillGaps, RefusesAbsurdWidths) {
  EXPECT_FALSE((GapFilling{-1}).validate());
  EXPECT_FALSE((GapFilling{65}).validate());
  EXPECT_FALSE((GapFilling{1, std::nan("")}).validate());
  EXPECT_TRUE((GapFilling{4}).validate());
}

}  // namespace
}  // namespace saccade
