// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/mesh.hpp"

#include <gtest/gtest.h>

namespace saccade {
namespace {

using Eigen::Vector3d;

TEST(ClosestPoint, IsFoundInEveryRegionOfATriangle) {
  const Vector3d a{0.0, 0.0, 0.0};
  const Vector3d b{2.0, 0.0, 0.0};
  const Vector3d c{0.0, 2.0, 0.0};
  EXPECT_TRUE(closest_point_on_triangle({0.5, 0.5, 3.0}, a, b, c).isApprox(Vector3d{0.5, 0.5, 0.0}));
  EXPECT_TRUE(closest_point_on_triangle({-1.0, -2.0, 1.0}, a, b, c).isZero());
  EXPECT_TRUE(closest_point_on_triangle({5.0, -1.0, 0.0}, a, b, c).isApprox(b));
  EXPECT_TRUE(closest_point_on_triangle({-1.0, 9.0, 0.0}, a, b, c).isApprox(c));
  EXPECT_TRUE(closest_point_on_triangle({1.0, -1.0, 1.0}, a, b, c).isApprox(Vector3d{1.0, 0.0, 0.0}));
  EXPECT_TRUE(closest_point_on_triangle({-1.0, 1.0, 1.0}, a, b, c).isApprox(Vector3d{0.0, 1.0, 0.0}));
  EXPECT_TRUE(closest_point_on_triangle({2.0, 2.0, 1.0}, a, b, c).isApprox(Vector3d{1.0, 1.0, 0.0}));
  EXPECT_TRUE(closest_point_on_triangle({1.0, 1.0, 0.0}, a, b, b).isApprox(Vector3d{1.0, 0.0, 0.0}));
  EXPECT_TRUE(closest_point_on_triangle({1.0, 1.0, 0.0}, b, b, b).isApprox(b));
}

}  // namespace
}  // namespace saccade
