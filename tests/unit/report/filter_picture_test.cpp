// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/depth_picture.hpp"

#include <gtest/gtest.h>

#include "unit/report/pixels.hpp"

namespace saccade {
namespace {

constexpr int kColumns{60};

TEST(FilterPicture, ShowsEveryRemovedPointInItsColor) {
  // Wide enough to be shown pixel by pixel.
  DepthImage before{400, 200, 1.0F};
  FilteredDepth filtered{before, {400, 200, FilteredPixel::kept}};
  for (int v = 0; v < 100; ++v) {
    for (int u = 0; u < kColumns; ++u) {
      const bool shadow = u < kColumns / 3;
      filtered.pixels(u, v) = shadow ? FilteredPixel::shadow_point : FilteredPixel::veil_point;
      filtered.depth(u, v) = 0.0F;
      ++(shadow ? filtered.shadow_points : filtered.veil_points);
    }
  }
  const auto colored = [](const ColorImage& picture) {
    return std::pair{test::count(picture, kShadowPointColor), test::count(picture, kVeilPointColor)};
  };
  const ColorImage some = filter_picture(before, filtered, "a frame");
  const ColorImage none = filter_picture(before, {before, {400, 200, FilteredPixel::kept}}, "a frame");
  EXPECT_GE(some.width(), 1200);
  EXPECT_EQ(colored(some).first - colored(none).first, filtered.shadow_points);
  EXPECT_EQ(colored(some).second - colored(none).second, filtered.veil_points);
  EXPECT_GT(test::count(some, test::is_dark), test::count(none, test::is_dark));
}

TEST(FilterPicture, TakesImagesWithoutReturns) {
  const DepthImage nothing{64, 48};
  EXPECT_FALSE(filter_picture(nothing, {nothing, {64, 48}}, "nothing").empty());
  EXPECT_THROW(filter_picture(nothing, {nothing, {64, 40}}, "sizes differ"), ContractViolation);
}

}  // namespace
}  // namespace saccade
