// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/convex_hull.hpp"

#include <gtest/gtest.h>

namespace saccade {
namespace {

using Eigen::Vector2d;

TEST(ConvexHull, CornersAreTheOutermostPoints) {
  const std::vector<Vector2d> hull =
      convex_hull({{0.0, 0.0}, {1.0, 0.0}, {0.5, 0.5}, {1.0, 1.0}, {0.0, 1.0}, {0.5, 0.0}, {1.0, 1.0}});
  ASSERT_EQ(hull.size(), 4U);
  EXPECT_EQ(hull[0], Vector2d(0.0, 0.0));
  EXPECT_EQ(hull[1], Vector2d(1.0, 0.0));
  EXPECT_EQ(hull[2], Vector2d(1.0, 1.0));
  EXPECT_LT(convex_hull({{0.0, 0.0}, {1.0, 1.0}, {2.0, 2.0}}).size(), 3U);
}

}  // namespace
}  // namespace saccade
