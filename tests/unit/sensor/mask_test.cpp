// SPDX-License-Identifier: Apache-2.0
#include "saccade/sensor/mask.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <random>

namespace saccade {
namespace {

/// Even-odd rule for one point, edge by edge.
bool inside_naive(std::span<const PixelPolygon> polygons, double u, double v) {
  bool inside = false;
  for (const PixelPolygon& polygon : polygons) {
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
      const auto& a = polygon[i];
      const auto& b = polygon[j];
      if ((a.y() <= v) == (b.y() <= v)) continue;
      if (u >= a.x() + (v - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
    }
  }
  return inside;
}

TEST(Mask, ScanLinesEqualThePointTest) {
  constexpr std::uint32_t kSeed{5};
  std::mt19937 random{kSeed};
  std::uniform_real_distribution<double> coordinate{-10.0, 50.0};
  std::size_t pixels = 0;
  for (int round = 0; round < 60; ++round) {
    std::vector<PixelPolygon> polygons(1 + random() % 3);
    for (PixelPolygon& polygon : polygons) {
      polygon.resize(3 + random() % 6);
      for (auto& vertex : polygon) vertex = {coordinate(random), coordinate(random)};
    }
    const auto mask = mask_from_polygons(40, 30, polygons);
    ASSERT_TRUE(mask);
    for (int v = 0; v < 30; ++v) {
      for (int u = 0; u < 40; ++u) {
        ASSERT_EQ((*mask)(u, v), inside_naive(polygons, u, v) ? 0 : 255) << round << ": " << u << " " << v;
        ++pixels;
      }
    }
  }
  std::cout << "seed " << kSeed << ", pixels " << pixels << "\n";
  EXPECT_EQ(pixels, 60U * 40U * 30U);
}

TEST(Mask, PolygonWithinAnotherIsAHole) {
  const std::vector<PixelPolygon> polygons{{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{3, 3}, {6, 3}, {6, 6}, {3, 6}}};
  const auto mask = mask_from_polygons(12, 12, polygons);
  ASSERT_TRUE(mask);
  EXPECT_EQ((*mask)(1, 1), 0);
  EXPECT_EQ((*mask)(4, 4), 255);
  EXPECT_EQ((*mask)(11, 11), 255);
  // Half open on either axis: neighbours that share an edge share no pixel.
  EXPECT_EQ((*mask)(0, 5), 0);
  EXPECT_EQ((*mask)(10, 5), 255);
  EXPECT_EQ((*mask)(3, 4), 255);
  EXPECT_EQ((*mask)(6, 4), 0);
}

TEST(Mask, RemovesReturnsAndFreeClaims) {
  DepthImage depth{3, 1};
  depth(0, 0) = 1.0F;
  depth(1, 0) = -2.0F;
  depth(2, 0) = 3.0F;
  MaskImage mask{3, 1, 0};
  mask(2, 0) = 1;
  ASSERT_TRUE(apply_mask(mask, depth));
  EXPECT_EQ(depth.pixels(), (std::vector<float>{0.0F, 0.0F, 3.0F}));
  EXPECT_EQ(apply_mask(MaskImage{2, 1}, depth).error().code, Errc::size_mismatch);
}

TEST(Mask, BadPolygonsAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(mask_from_polygons(4, 4, std::vector<PixelPolygon>{{{0, 0}, {1, 1}}}));
  EXPECT_FALSE(mask_from_polygons(4, 4, std::vector<PixelPolygon>{{{0, 0}, {1, 1}, {nan, 0}}}));
  EXPECT_FALSE(mask_from_polygons(0, 4, {}));
  const auto all = mask_from_polygons(4, 4, {});
  ASSERT_TRUE(all);
  EXPECT_EQ(*all, (MaskImage{4, 4, 255}));
}

TEST(ClipToRange, ReturnsOutsideCountAsNone) {
  PinholeCamera camera;
  camera.min_range_m = 0.5;
  camera.max_range_m = 4.0;
  const float infinity = std::numeric_limits<float>::infinity();
  DepthImage depth{9, 1,
                   std::vector<float>{0.0F, 0.49F, 0.5F, 4.0F, 4.01F, std::numeric_limits<float>::quiet_NaN(), infinity,
                                      -3.0F, -9.0F}};
  clip_to_range(camera, depth);
  EXPECT_EQ(depth.pixels(), (std::vector<float>{0.0F, 0.0F, 0.5F, 4.0F, 0.0F, 0.0F, 0.0F, -3.0F, -4.0F}));
  DepthImage near{2, 1, std::vector<float>{-0.2F, -infinity}};
  clip_to_range(camera, near);
  EXPECT_EQ(near.pixels(), (std::vector<float>{0.0F, -4.0F}));
}

}  // namespace
}  // namespace saccade
