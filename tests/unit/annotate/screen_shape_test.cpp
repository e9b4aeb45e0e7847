// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/selection.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace saccade {
namespace {

/// One line per row; x: in the shape.
std::string drawn(const ScreenShape& shape, int width, int height) {
  EXPECT_TRUE(validate(shape).ok());
  const ScreenMask mask{shape, width, height};
  std::string picture;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) picture += mask.contains(u, v) ? 'x' : '.';
    picture += '\n';
  }
  return picture;
}

TEST(ScreenMask, ARectangleHasThePixelsWithCentresFromItsLesserToBeforeItsGreaterCoordinates) {
  EXPECT_EQ(drawn(ScreenRectangle{{1.0, 0.0}, {3.0, 2.0}}, 4, 3), ".xx.\n.xx.\n....\n");
  EXPECT_EQ(drawn(ScreenRectangle{{3.0, 2.0}, {1.0, 0.0}}, 4, 3), ".xx.\n.xx.\n....\n");
  EXPECT_EQ(drawn(ScreenRectangle{{0.5, 0.5}, {2.5, 2.5}}, 4, 3), "xx..\nxx..\n....\n");
  EXPECT_EQ(drawn(ScreenRectangle{{0.6, -9.0}, {9.0, 0.6}}, 4, 2), ".xxx\n....\n");
  EXPECT_EQ(drawn(ScreenRectangle{{1.0, 1.0}, {1.0, 2.0}}, 3, 2), "...\n...\n");
  EXPECT_EQ(drawn(ScreenRectangle{{5.0, 0.0}, {9.0, 9.0}}, 3, 2), "...\n...\n");
}

TEST(ScreenMask, APolygonHasItsLeftAndUpperBorderAndHolesWhereItCrossesItself) {
  EXPECT_EQ(drawn(ScreenPolygon{{{0.5, 0.5}, {2.5, 0.5}, {2.5, 2.5}, {0.5, 2.5}}}, 4, 3), "xx..\nxx..\n....\n");
  EXPECT_EQ(drawn(ScreenPolygon{{{0.0, 0.0}, {4.0, 0.0}, {0.0, 4.0}}}, 4, 4), "xxx.\nxx..\nx...\n....\n");
  const ScreenPolygon twice_around{{{0, 0}, {5, 0}, {5, 5}, {0, 5}, {0, 0}, {1, 1}, {4, 1}, {4, 4}, {1, 4}, {1, 1}}};
  EXPECT_EQ(drawn(twice_around, 5, 5), "xxxxx\nx...x\nx...x\nx...x\nxxxxx\n");
  EXPECT_EQ(drawn(ScreenPolygon{{{-5, 1}, {9, 1}, {9, 2}, {-5, 2}}}, 3, 3), "...\nxxx\n...\n");
}

TEST(ScreenMask, AStrokeHasAllWithinItsRadiusBorderIncluded) {
  EXPECT_EQ(drawn(ScreenStroke{{{2.5, 2.5}}, 1.0}, 5, 5), ".....\n..x..\n.xxx.\n..x..\n.....\n");
  EXPECT_EQ(drawn(ScreenStroke{{{1.5, 1.5}, {3.5, 1.5}}, 1.0}, 6, 3), ".xxx..\nxxxxx.\n.xxx..\n");
  EXPECT_EQ(drawn(ScreenStroke{{{0.5, 0.5}, {0.5, 2.5}, {2.5, 2.5}}, 0.25}, 3, 3), "x..\nx..\nxxx\n");
  EXPECT_EQ(drawn(ScreenStroke{{{1.5, -3.0}}, 3.5}, 3, 2), ".x.\n...\n");
}

TEST(ScreenShape, WhatIsNoShapeIsRefused) {
  constexpr double kNan{std::numeric_limits<double>::quiet_NaN()};
  const auto is_refused = [](const ScreenShape& shape) {
    const Status status = validate(shape);
    return !status.ok() && status.error().code == Errc::invalid_argument;
  };
  EXPECT_TRUE(is_refused(ScreenRectangle{{0.0, kNan}, {1.0, 1.0}}));
  EXPECT_TRUE(is_refused(ScreenRectangle{{0.0, 0.0}, {1e7, 1.0}}));
  EXPECT_TRUE(is_refused(ScreenPolygon{{{0.0, 0.0}, {1.0, 1.0}}}));
  EXPECT_TRUE(is_refused(ScreenPolygon{std::vector<ScreenPoint>(10'001, ScreenPoint{0.0, 0.0})}));
  EXPECT_TRUE(is_refused(ScreenStroke{{}, 1.0}));
  EXPECT_TRUE(is_refused(ScreenStroke{{{0.0, 0.0}}, 0.0}));
  EXPECT_TRUE(is_refused(ScreenStroke{{{0.0, 0.0}}, kNan}));
  EXPECT_TRUE(is_refused(ScreenStroke{{{kNan, 0.0}}, 1.0}));
}

}  // namespace
}  // namespace saccade
