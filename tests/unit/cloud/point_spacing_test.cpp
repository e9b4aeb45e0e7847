// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/point_spacing.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace saccade {
namespace {

TEST(PointSpacing, IsTheMedianDistanceToTheNearestPoint) {
  std::vector<Eigen::Vector3f> grid;
  for (int x = 0; x < 20; ++x) {
    for (int y = 0; y < 20; ++y) grid.emplace_back(0.04F * float(x), 0.04F * float(y), 0.0F);
  }
  grid.emplace_back(100.0F, 0.0F, 0.0F);  // a stray point
  grid.push_back(grid.front());           // and one twice at its place
  grid.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F);
  const auto spacing_m = point_spacing_m(grid, Executor{});
  ASSERT_TRUE(spacing_m.has_value());
  EXPECT_NEAR(*spacing_m, 0.04, 1e-6);
  EXPECT_EQ(point_spacing_m(grid, Executor::with_threads(3)), spacing_m);
}

TEST(PointSpacing, NeedsTwoPlaces) {
  const std::vector<Eigen::Vector3f> one{{1.0F, 2.0F, 3.0F}, {1.0F, 2.0F, 3.0F}};
  EXPECT_EQ(point_spacing_m(one, Executor{}), std::nullopt);
  EXPECT_EQ(point_spacing_m({}, Executor{}), std::nullopt);
}

}  // namespace
}  // namespace saccade
